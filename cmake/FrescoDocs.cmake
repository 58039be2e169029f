# Target docs_site: HTML of the Markdown pages, the tools' help and the public headers, in build/site/html (Doxygen).
find_package(Doxygen QUIET)
if(DOXYGEN_FOUND AND TARGET fresco_tools AND NOT CMAKE_CROSSCOMPILING)
  set(FRESCO_SITE "${PROJECT_BINARY_DIR}/site")
  fresco_add_tool_pages(markdown "${FRESCO_SITE}/tools" ".md" tool_pages)
  set(tool_list "# Tools {#tools}\n\nWhat each prints with `-h`.\n\n")
  foreach(page IN LISTS tool_pages)
    get_filename_component(name "${page}" NAME_WE)
    string(APPEND tool_list "- \\subpage tool_${name}\n")
  endforeach()
  file(WRITE "${FRESCO_SITE}/tools/tools.md" "${tool_list}")

  set(includes "")
  foreach(module common filters surface registration tracking alignment texture model)
    list(APPEND includes "\"${PROJECT_SOURCE_DIR}/${module}/include\"")
  endforeach()
  string(JOIN " " FRESCO_SITE_INCLUDES ${includes})
  set(FRESCO_SITE_INPUT "\"${PROJECT_SOURCE_DIR}/docs\" \"${PROJECT_SOURCE_DIR}/CONTRIBUTING.md\" \"${FRESCO_SITE}/tools\" ${FRESCO_SITE_INCLUDES}")
  configure_file("${PROJECT_SOURCE_DIR}/docs/site/Doxyfile.in" "${FRESCO_SITE}/Doxyfile" @ONLY)
  add_custom_target(docs_site
    COMMAND Doxygen::doxygen "${FRESCO_SITE}/Doxyfile"
    COMMAND "${CMAKE_COMMAND}" -D "WARNINGS=${FRESCO_SITE}/warnings.txt"
            -D "HTML=${FRESCO_SITE}/html" -P "${PROJECT_SOURCE_DIR}/cmake/site_warnings.cmake"
    DEPENDS ${tool_pages} COMMENT "Documentation in ${FRESCO_SITE}/html/index.html" VERBATIM)
endif()
