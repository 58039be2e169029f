# fresco_add_module(NAME SOURCES file... [DEPENDS target...] [PRIVATE_DEPENDS target...])
# One shared library fresco_NAME, alias fresco::NAME, headers below include/fresco/NAME, installed and exported.
function(fresco_add_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  if(NOT ARG_SOURCES)
    return()
  endif()
  set(target fresco_${name})
  add_library(${target} ${ARG_SOURCES})
  add_library(fresco::${name} ALIAS ${target})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_17)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O3>)
  target_link_libraries(${target} PUBLIC ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE_DEPENDS} $<BUILD_INTERFACE:fresco_warnings>)
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
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
endfunction()

# fresco_add_tool(NAME SOURCES file... [DEPENDS target...]): program fresco_NAME, installed; part of target fresco_tools.
function(fresco_add_tool name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(fresco_${name} ${ARG_SOURCES})
  target_link_libraries(fresco_${name} PRIVATE fresco_tool_support ${ARG_DEPENDS} fresco_warnings)
  target_link_options(fresco_${name} PRIVATE -Wl,--as-needed)
  install(TARGETS fresco_${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
  if(NOT TARGET fresco_tools)
    add_custom_target(fresco_tools)
  endif()
  add_dependencies(fresco_tools fresco_${name})
endfunction()

# fresco_add_test(NAME SOURCES file... [DEPENDS target...]): GoogleTest program test_NAME, one ctest entry.
# The environment variable FRESCO_DATA names the folder of real data; its tests are skipped where it is absent.
function(fresco_add_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(test_${name} ${ARG_SOURCES})
  target_link_libraries(test_${name} PRIVATE ${ARG_DEPENDS} GTest::gtest_main fresco_warnings)
  target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/test)
  target_compile_definitions(test_${name} PRIVATE FRESCO_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                             FRESCO_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_link_options(test_${name} PRIVATE -Wl,--as-needed)
  add_test(NAME ${name} COMMAND test_${name})
  set(timeout 600)
  if(FRESCO_SANITIZE)
    set(timeout 7200)
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${timeout})
endfunction()
