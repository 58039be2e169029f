# fresco_add_module(NAME SOURCES file... [DEPENDS target...] [PRIVATE_DEPENDS target...] [HEADERS folder...])
# One shared library fresco_NAME, alias fresco::NAME, installed and exported. Public headers: include/fresco/FOLDER for each
# folder of HEADERS (default: NAME). Symbols are hidden but for those marked FRESCO_EXPORT. Tests and measurements of
# private parts link fresco_NAME_parts, a static library of the same objects, which also knows src/.
function(fresco_add_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS;HEADERS" ${ARGN})
  set(target fresco_${name})
  set(objects ${target}_objects)
  add_library(${objects} OBJECT ${ARG_SOURCES})
  add_library(${target} $<TARGET_OBJECTS:${objects}>)
  add_library(${target}_parts STATIC EXCLUDE_FROM_ALL $<TARGET_OBJECTS:${objects}>)
  add_library(fresco::${name} ALIAS ${target})
  foreach(kind ${objects} ${target} ${target}_parts)
    target_include_directories(${kind} PUBLIC
      $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_compile_features(${kind} PUBLIC cxx_std_17)
    target_link_libraries(${kind} PUBLIC ${ARG_DEPENDS} PRIVATE $<BUILD_INTERFACE:fresco_warnings>)
    target_link_libraries(${kind} PRIVATE ${ARG_PRIVATE_DEPENDS})
  endforeach()
  target_include_directories(${objects} PRIVATE "${CMAKE_CURRENT_SOURCE_DIR}/src")
  target_include_directories(${target}_parts INTERFACE "${CMAKE_CURRENT_SOURCE_DIR}/src")
  target_compile_options(${objects} PRIVATE $<$<CONFIG:Release>:-O3>)
  fresco_precompile(${objects})
  fresco_unite(${objects})
  set_target_properties(${objects} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  set_target_properties(${target} ${target}_parts PROPERTIES LINKER_LANGUAGE CXX)
  target_link_options(${target} PRIVATE -Wl,--as-needed)
  if(NOT FRESCO_SANITIZE) # a sanitizer's own symbols are found when the program starts
    target_link_options(${target} PRIVATE -Wl,--no-undefined)
  endif()
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  install(TARGETS ${target} EXPORT frescoTargets
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
          RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
  if(NOT DEFINED ARG_HEADERS)
    set(ARG_HEADERS ${name})
  endif()
  foreach(folder IN LISTS ARG_HEADERS)
    install(DIRECTORY include/fresco/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/fresco COMPONENT development)
  endforeach()
endfunction()

# fresco_add_tool(NAME SOURCES file... [DEPENDS target...]): program fresco_NAME, installed; part of target fresco_tools.
# Its target is fresco_tool_NAME, since some modules have the name of a tool.
function(fresco_add_tool name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  set(target fresco_tool_${name})
  add_executable(${target} ${ARG_SOURCES})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME fresco_${name})
  target_link_libraries(${target} PRIVATE fresco_tool_support ${ARG_DEPENDS} fresco_warnings)
  target_link_options(${target} PRIVATE -Wl,--as-needed)
  install(TARGETS ${target} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
  if(NOT TARGET fresco_tools)
    add_custom_target(fresco_tools)
  endif()
  add_dependencies(fresco_tools ${target})
endfunction()

# fresco_add_test(NAME SOURCES file... [DEPENDS target...] [SHARDS n]): GoogleTest program test_NAME, one ctest entry; with
# SHARDS its tests are dealt out to n entries NAME_0, NAME_1, ..., which may run at once.
# The environment variable FRESCO_DATA names the folder of real data; its tests are skipped where it is absent.
function(fresco_add_test name)
  cmake_parse_arguments(ARG "" "SHARDS" "SOURCES;DEPENDS" ${ARGN})
  add_executable(test_${name} ${ARG_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${ARG_DEPENDS} fresco_test_folders GTest::gtest_main fresco_warnings)
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/test ${PROJECT_SOURCE_DIR}/tools
                             ${PROJECT_SOURCE_DIR}/simulation/include)
  target_link_options(test_${name} PRIVATE -Wl,--as-needed)
  fresco_precompile(test_${name} <gtest/gtest.h>)
  set(timeout 600)
  if(FRESCO_SANITIZE)
    set(timeout 7200)
  endif()
  if(NOT ARG_SHARDS)
    add_test(NAME ${name} COMMAND test_${name})
    set_tests_properties(${name} PROPERTIES TIMEOUT ${timeout})
    return()
  endif()
  math(EXPR last "${ARG_SHARDS} - 1")
  foreach(shard RANGE ${last})
    add_test(NAME ${name}_${shard} COMMAND test_${name})
    set_tests_properties(
      ${name}_${shard} PROPERTIES TIMEOUT ${timeout} ENVIRONMENT
                                  "GTEST_TOTAL_SHARDS=${ARG_SHARDS};GTEST_SHARD_INDEX=${shard}")
  endforeach()
endfunction()
