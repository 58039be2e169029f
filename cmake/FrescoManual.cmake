# Manual pages and pages of the documentation, made from what each tool prints with -h.
# fresco_add_tool_pages(FORMAT FOLDER EXTENSION RESULT): rules for one page per tool; RESULT = list of the files.
function(fresco_add_tool_pages format folder extension result)
  get_target_property(tools fresco_tools MANUALLY_ADDED_DEPENDENCIES)
  set(pages "")
  foreach(tool IN LISTS tools)
    get_target_property(name ${tool} OUTPUT_NAME)
    if(NOT name)
      set(name ${tool})
    endif()
    set(page "${folder}/${name}${extension}")
    add_custom_command(OUTPUT "${page}"
      COMMAND "${CMAKE_COMMAND}" -D "TOOL=$<TARGET_FILE:${tool}>" -D "NAME=${name}" -D "VERSION=${PROJECT_VERSION}"
              -D "FORMAT=${format}" -D "OUT=${page}" -P "${PROJECT_SOURCE_DIR}/cmake/tool_page.cmake"
      DEPENDS ${tool} "${PROJECT_SOURCE_DIR}/cmake/tool_page.cmake"
      COMMENT "Help of ${name} as ${format}" VERBATIM)
    list(APPEND pages "${page}")
  endforeach()
  set(${result} "${pages}" PARENT_SCOPE)
endfunction()

if(TARGET fresco_tools AND NOT CMAKE_CROSSCOMPILING)
  fresco_add_tool_pages(man "${PROJECT_BINARY_DIR}/man" ".1" manual_pages)
  foreach(page IN LISTS manual_pages) # Debian wants them compressed, without a time
    add_custom_command(OUTPUT "${page}.gz" COMMAND gzip -9nkf "${page}" DEPENDS "${page}" VERBATIM)
  endforeach()
  list(TRANSFORM manual_pages APPEND ".gz")
  add_custom_target(fresco_manual ALL DEPENDS ${manual_pages})
  install(FILES ${manual_pages} DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT tools)
endif()
