# Installs the build tree, builds examples/ against the installed package alone and runs them.
#   cmake -D BINARY_DIR=... -D SOURCE_DIR=... -D SCRATCH=... -D SOVERSION=0.1 [-D SANITIZE=...] [-D PYTHON=...] -P install_test.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    string(JOIN " " command ${ARGN})
    message(FATAL_ERROR "failed (${status}): ${command}")
  endif()
endfunction()

function(expect_file file)
  if(NOT EXISTS "${file}")
    message(FATAL_ERROR "${file} was not written")
  endif()
endfunction()

set(prefix "${SCRATCH}/prefix")
set(build "${SCRATCH}/build")
set(flags "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}")
if(SANITIZE) # the runtime that the libraries want must be the program's
  list(APPEND flags "-DCMAKE_EXE_LINKER_FLAGS=-fsanitize=${SANITIZE}")
endif()
file(REMOVE_RECURSE "${SCRATCH}")
run("${CMAKE_COMMAND}" --install "${BINARY_DIR}" --prefix "${prefix}")
run("${CMAKE_COMMAND}" -S "${SOURCE_DIR}/examples" -B "${build}" -G Ninja -DCMAKE_BUILD_TYPE=Release
    "-DCMAKE_PREFIX_PATH=${prefix}" ${flags})
file(STRINGS "${build}/CMakeCache.txt" found REGEX "^fresco_DIR:")
if(NOT found MATCHES "${prefix}")
  message(FATAL_ERROR "the package was not found in the installed tree but elsewhere: ${found}")
endif()
run("${CMAKE_COMMAND}" --build "${build}" --parallel 2)
run("${CMAKE_COMMAND}" -E chdir "${build}" "${build}/pcl_pipeline" "${SCRATCH}/mesh.ply")
expect_file("${SCRATCH}/mesh.ply")
run("${prefix}/bin/fresco_compare" "${SCRATCH}/mesh.ply" "${SCRATCH}/mesh.ply") # installed tools find their libraries

# The Python module finds its libraries in the installed tree.
set(python_packages "${prefix}/lib/python3/dist-packages")
if(PYTHON)
  run("${CMAKE_COMMAND}" -E env "PYTHONPATH=${python_packages}" PYTHONDONTWRITEBYTECODE=1 "${PYTHON}" -c
      "import sys, fresco; assert fresco.__file__.startswith(sys.argv[1]); fresco.snapshot(fresco.read_mesh(sys.argv[2]))"
      "${python_packages}" "${SCRATCH}/mesh.ply")
  expect_file("${python_packages}/fresco/_fresco.pyi")
  expect_file("${python_packages}/fresco/py.typed")
endif()

# The other examples on a room of the virtual scanner.
set(room "${SCRATCH}/room")
run("${prefix}/bin/fresco_scan" conference_room "${room}" -stations 2 -points 15000 -views 4 -images 160x120 -quiet)
run("${build}/filter_chain" "${room}/scans/scan_00.pcd" "${SCRATCH}/filtered.pcd")
expect_file("${SCRATCH}/filtered.pcd")
run("${build}/from_pcl" "${room}/scans/scan_00.pcd" "${SCRATCH}/from_pcl.ply")
expect_file("${SCRATCH}/from_pcl.ply")
run("${build}/optimization" "${SCRATCH}/filtered.pcd" 0.05 "${SCRATCH}/sharp.ply")
expect_file("${SCRATCH}/sharp.ply")
run("${build}/registration" "${SCRATCH}/registered.pcd" "${room}/scans/scan_00.pcd" "${room}/scans/scan_01.pcd")
expect_file("${SCRATCH}/registered.pcd")
run("${build}/texture" "${room}/truth.ply" "${room}/cameras" "${room}/images" "${SCRATCH}/textured")
expect_file("${SCRATCH}/textured/model.obj")
expect_file("${SCRATCH}/textured/texture_0.png")
run("${build}/model" "${room}" "${SCRATCH}/model")
expect_file("${SCRATCH}/model/model.glb")
expect_file("${SCRATCH}/model/report.html")

# The pieces of code in the documentation compile.
set(snippets "${SCRATCH}/snippets")
run("${CMAKE_COMMAND}" -D "PAGE=${SOURCE_DIR}/docs/migration.md" -D "OUT=${snippets}/migration.cpp"
    -P "${SOURCE_DIR}/test/package/snippets.cmake")
file(WRITE "${snippets}/CMakeLists.txt" "cmake_minimum_required(VERSION 3.20)\nproject(snippets LANGUAGES C CXX)\n"
     "find_package(fresco REQUIRED COMPONENTS surface filters)\nadd_executable(migration migration.cpp)\n"
     "target_link_libraries(migration PRIVATE fresco::surface fresco::filters)\n")
run("${CMAKE_COMMAND}" -S "${snippets}" -B "${snippets}/build" -G Ninja "-DCMAKE_PREFIX_PATH=${prefix}"
    ${flags})
run("${CMAKE_COMMAND}" --build "${snippets}/build")

# Links of the installed pages lead to installed files.
set(pages "${prefix}/share/doc/fresco")
file(GLOB_RECURSE names "${pages}/*.md")
expect_file("${pages}/docs/index.md")
foreach(name IN LISTS names)
  get_filename_component(folder "${name}" DIRECTORY)
  file(READ "${name}" text)
  string(REGEX MATCHALL "\\([A-Za-z0-9_./-]+\\.(md|cpp|ipynb|bib|jpg|png)[#)]" links "${text}")
  foreach(link IN LISTS links)
    string(REGEX REPLACE "^\\(|[#)]$" "" link "${link}")
    expect_file("${folder}/${link}")
  endforeach()
endforeach()

# What a package holds besides.
file(GLOB_RECURSE installed RELATIVE "${prefix}" "${prefix}/*")
foreach(part "libfresco_core.so.${SOVERSION}" "libfresco_surface.so.${SOVERSION}." share/man/man1/fresco_model.1.gz
             include/fresco/surface/volumetric_reconstruction.h include/fresco/model/build_model.h share/doc/libfresco[0-9.]+/copyright frescoConfig.cmake)
  if(NOT installed MATCHES "${part}")
    message(FATAL_ERROR "${part} was not installed")
  endif()
endforeach()

# No program or library searches the current folder: what an empty entry of its search path means.
find_program(readelf readelf REQUIRED)
file(GLOB binaries "${BINARY_DIR}/bin/*" "${BINARY_DIR}/lib/*.so" "${BINARY_DIR}/lib/*/*.so" "${prefix}/bin/*"
     "${prefix}/lib/*.so" "${prefix}/lib/*/*.so" "${python_packages}/fresco/*.so")
list(FILTER binaries EXCLUDE REGEX "\\.(py|sh|txt)$")
file(STRINGS "${BINARY_DIR}/CMakeCache.txt" is_release REGEX "^CMAKE_BUILD_TYPE:.*=Release$")
foreach(binary IN LISTS binaries)
  execute_process(COMMAND "${readelf}" -d "${binary}" OUTPUT_VARIABLE dynamic ERROR_QUIET)
  if(dynamic MATCHES "R(UN)?PATH\\)[^[]*\\[([^]]*)\\]")
    set(search_path "${CMAKE_MATCH_2}")
    if(":${search_path}:" MATCHES "::")
      message(FATAL_ERROR "${binary} searches the current folder: ${search_path}")
    endif()
    if("${search_path}" MATCHES "mpi" AND NOT "${binary}" MATCHES "_mpi$")
      message(FATAL_ERROR "${binary} searches the folder of MPI, which it does not load: ${search_path}")
    endif()
  endif()
  # What a release build is hardened by (cmake/FrescoSettings.cmake).
  if(is_release AND NOT dynamic MATCHES "BIND_NOW|FLAGS_1\\)[^\n]*NOW")
    message(FATAL_ERROR "${binary} is not bound at its start")
  endif()
endforeach()

# A component that does not exist is named.
file(WRITE "${SCRATCH}/wrong/CMakeLists.txt" "cmake_minimum_required(VERSION 3.20)\nproject(wrong LANGUAGES C CXX)\n"
     "find_package(fresco REQUIRED COMPONENTS nonsense)\n")
execute_process(COMMAND "${CMAKE_COMMAND}" -S "${SCRATCH}/wrong" -B "${SCRATCH}/wrong/build" "-DCMAKE_PREFIX_PATH=${prefix}"
                RESULT_VARIABLE status ERROR_VARIABLE said OUTPUT_QUIET)
if(status EQUAL 0 OR NOT said MATCHES "nonsense")
  message(FATAL_ERROR "a component that does not exist was not refused: ${said}")
endif()
