# Debian packages: cpack -G DEB in the build folder gives libfresco0.1 (libraries), fresco-tools (tools, manual),
# libfresco-dev (headers, CMake package), python3-fresco and fresco-doc (pages, examples). Configure with
# -DCMAKE_INSTALL_PREFIX=/usr, so that libraries go to Debian's folder for them. The sources as one file:
#   git archive --prefix=fresco-0.1.0/ -o fresco-0.1.0.tar.gz HEAD
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME fresco)
set(CPACK_PACKAGE_VENDOR "The fresco authors")
set(CPACK_PACKAGE_CONTACT "The fresco authors <fresco@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Textured models from indoor laser and RGB-D scans")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_COMPONENTS_ALL "")

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}") # what the packages bring themselves

# Debian wants a changelog of each package, compressed without a time.
set(debian_changelog "${PROJECT_BINARY_DIR}/changelog.Debian")
file(TIMESTAMP "${PROJECT_SOURCE_DIR}/CHANGELOG.md" release_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE "${debian_changelog}" "fresco (${PROJECT_VERSION}-1) unstable; urgency=medium

  * Release ${PROJECT_VERSION}; package fresco-doc has the list of changes.

 -- ${CPACK_PACKAGE_CONTACT}  ${release_date}\n")
execute_process(COMMAND gzip -9nf "${debian_changelog}")

# fresco_debian_package(COMPONENT PACKAGE SECTION DEPENDS DESCRIPTION): where an installed component goes.
macro(fresco_debian_package component package section depends description)
  string(TOUPPER ${component} key)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${package})
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${key}_PACKAGE_DEPENDS "${depends}")
  set(CPACK_COMPONENT_${key}_DESCRIPTION "${description}")
  set(folder "${CMAKE_INSTALL_DATADIR}/doc/${package}")
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${folder}" RENAME copyright COMPONENT ${component})
  install(FILES "${debian_changelog}.gz" DESTINATION "${folder}" COMPONENT ${component})
  file(WRITE "${PROJECT_BINARY_DIR}/lintian/${package}" "# no upload to Debian: no report asks for the package
${package}: initial-upload-closes-no-bugs
# one package for the libraries of all modules, which are released together
${package}: package-name-doesnt-match-sonames
# cpack writes the scripts
${package}: maintscript-calls-ldconfig
# Open MPI's own folder, in the programs of several processes alone
${package}: custom-library-search-path\n")
  install(FILES "${PROJECT_BINARY_DIR}/lintian/${package}" DESTINATION "${CMAKE_INSTALL_DATADIR}/lintian/overrides"
          COMPONENT ${component})
endmacro()

set(libraries libfresco${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(same_libraries "${libraries} (= ${PROJECT_VERSION}-1)")
fresco_debian_package(runtime ${libraries} libs "libegl-mesa0, libgl1-mesa-dri" # loaded by libEGL when pictures are drawn
  "Libraries that clean and register laser or RGB-D scans, reconstruct a\nwatertight surface and texture it from \
calibrated photographs.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
file(WRITE "${PROJECT_BINARY_DIR}/triggers" "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/triggers")
fresco_debian_package(tools fresco-tools graphics "${same_libraries}"
  "Command line tools that clean and register laser or RGB-D scans,\nreconstruct a watertight surface and texture it from \
calibrated photographs.")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
fresco_debian_package(development libfresco-dev libdevel
  "${same_libraries}, libpcl-dev (>= 1.12), libeigen3-dev (>= 3.4)" "Headers and CMake package of fresco: PCL-compatible classes.")
fresco_debian_package(documentation fresco-doc doc "" "Documentation and example programs of fresco.")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
if(TARGET fresco_python)
  execute_process(COMMAND "${FRESCO_PYTHON}" -c "import sys; print('%d.%d' % sys.version_info[:2])"
                  OUTPUT_VARIABLE python_version OUTPUT_STRIP_TRAILING_WHITESPACE)
  string(REGEX REPLACE "^.*[.]" "" next_minor "${python_version}")
  math(EXPR next_minor "${next_minor} + 1")
  fresco_debian_package(python python3-fresco python
    "${same_libraries}, python3 (>= ${python_version}), python3 (<< 3.${next_minor}), python3-numpy"
    "Python module of fresco: every stage from numpy arrays.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
endif()
include(CPack)
