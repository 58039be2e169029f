# Build-wide settings: build type, output folders, compiler cache.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo or MinSizeRel" FORCE)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR};$ORIGIN")
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON) # libraries outside of the system's folders
# The build tree is laid out like the installed files and searches the same folders. With a search path of its own CMake
# would end it with ":" to have room for the other, and that means the current folder.
set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# The compiler's cache keeps objects of precompiled headers only if it is told so. One program, as CMake's variable goes on to
# builds of examples.
find_program(FRESCO_CCACHE ccache)
if(FRESCO_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  file(CONFIGURE OUTPUT "${CMAKE_BINARY_DIR}/ccache" CONTENT "#!/bin/sh
CCACHE_SLOPPINESS=pch_defines,time_macros exec '@FRESCO_CCACHE@' \"$@\"\n" @ONLY)
  file(CHMOD "${CMAKE_BINARY_DIR}/ccache" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_BINARY_DIR}/ccache")
endif()

# Headers of Eigen and of the standard library are read once per target. Without, files must name all that they use: the
# builds with sanitizers hold them to that, and -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON.
function(fresco_precompile target)
  get_target_property(sources ${target} SOURCES)
  list(LENGTH sources count)
  if(FRESCO_SANITIZE OR count LESS 4) # fewer files do not pay for it
    return()
  endif()
  foreach(source IN LISTS sources)
    if(source MATCHES "_avx2") # other instructions than those of the precompiled ones
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
  target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <functional> <map> <optional> <string> <vector>
                            <Eigen/Dense> ${ARGN})
  target_compile_options(${target} PRIVATE $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-fpch-preprocess>)
endfunction()

# Templates of Eigen that several files of a module use are instantiated once for twelve files. Names of a module's files
# are unlike for that, those of the innermost namespaces too.
option(FRESCO_UNITY "Compile files of a module together: less time from nothing, more after a change of one file" ON)
if(FRESCO_UNITY AND NOT CMAKE_JOB_POOL_COMPILE) # a compiler takes up to 2 GB then; Ninja starts no more than fit
  cmake_host_system_information(RESULT fresco_memory QUERY TOTAL_PHYSICAL_MEMORY)
  math(EXPR fresco_jobs "${fresco_memory} / 2000 + 1")
  set_property(GLOBAL APPEND PROPERTY JOB_POOLS compile=${fresco_jobs})
  set(CMAKE_JOB_POOL_COMPILE compile)
endif()
function(fresco_unite target)
  if(FRESCO_UNITY AND NOT FRESCO_SANITIZE)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
  endif()
endfunction()

# Warnings for our own targets only.
add_library(fresco_warnings INTERFACE)
target_compile_options(fresco_warnings INTERFACE -Wall -Wextra -Wpedantic
                       $<$<NOT:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>>:-Wshadow>) # else of names of other files

set(FRESCO_SANITIZE "" CACHE STRING "Sanitizers to build with, as in -fsanitize=..., e.g. address,undefined")
if(FRESCO_SANITIZE)
  add_compile_options(-fsanitize=${FRESCO_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${FRESCO_SANITIZE})
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1) # PCL's own allocations are taken for foreign ones otherwise
endif()

# Eigen's fast square roots begin with the processor's own estimate of 1/sqrt(x), which differs between makers.
add_compile_definitions(EIGEN_FAST_MATH=0)

# Release builds: an overrun stack or buffer of known size ends the program, as does a jump to where no function begins, and
# addresses of functions of libraries are looked up at the start and cannot be changed after it.
add_compile_options($<$<CONFIG:Release>:-fstack-protector-strong> $<$<CONFIG:Release>:-fstack-clash-protection>
                    $<$<CONFIG:Release>:-U_FORTIFY_SOURCE> $<$<CONFIG:Release>:-D_FORTIFY_SOURCE=2>)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  add_compile_options($<$<CONFIG:Release>:-fcf-protection>)
endif()
add_link_options($<$<CONFIG:Release>:LINKER:-z,relro,-z,now>)

option(FRESCO_COVERAGE "Count which lines run (gcov)" OFF)
if(FRESCO_COVERAGE)
  add_compile_options(--coverage -fprofile-update=atomic)
  add_link_options(--coverage)
endif()
