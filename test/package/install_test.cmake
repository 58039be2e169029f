# Installs the build tree, builds examples/ against the installed package alone and runs them.
#   cmake -D BINARY_DIR=... -D SOURCE_DIR=... -D SCRATCH=... -P install_test.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    string(JOIN " " command ${ARGN})
    message(FATAL_ERROR "failed (${status}): ${command}")
  endif()
endfunction()

set(prefix "${SCRATCH}/prefix")
set(build "${SCRATCH}/build")
file(REMOVE_RECURSE "${SCRATCH}")
run("${CMAKE_COMMAND}" --install "${BINARY_DIR}" --prefix "${prefix}")
run("${CMAKE_COMMAND}" -S "${SOURCE_DIR}/examples" -B "${build}" -G Ninja -DCMAKE_BUILD_TYPE=Release
    "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}")
file(STRINGS "${build}/CMakeCache.txt" found REGEX "^fresco_DIR:")
if(NOT found MATCHES "${prefix}")
  message(FATAL_ERROR "the package was not found in the installed tree but elsewhere: ${found}")
endif()
run("${CMAKE_COMMAND}" --build "${build}" --parallel 2)
run("${CMAKE_COMMAND}" -E chdir "${build}" "${build}/pcl_pipeline" "${SCRATCH}/mesh.ply")
if(NOT EXISTS "${SCRATCH}/mesh.ply")
  message(FATAL_ERROR "the example wrote no mesh")
endif()
run("${prefix}/bin/fresco_compare" "${SCRATCH}/mesh.ply" "${SCRATCH}/mesh.ply") # installed tools find their libraries

# A component that does not exist is named.
file(WRITE "${SCRATCH}/wrong/CMakeLists.txt" "cmake_minimum_required(VERSION 3.20)\nproject(wrong LANGUAGES C CXX)\n"
     "find_package(fresco REQUIRED COMPONENTS nonsense)\n")
execute_process(COMMAND "${CMAKE_COMMAND}" -S "${SCRATCH}/wrong" -B "${SCRATCH}/wrong/build" "-DCMAKE_PREFIX_PATH=${prefix}"
                RESULT_VARIABLE status ERROR_VARIABLE said OUTPUT_QUIET)
if(status EQUAL 0 OR NOT said MATCHES "nonsense")
  message(FATAL_ERROR "a component that does not exist was not refused: ${said}")
endif()
