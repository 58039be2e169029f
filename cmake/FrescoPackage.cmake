# Debian packages: cpack -G DEB in the build folder gives fresco (libraries, tools, manual), libfresco-dev (headers,
# CMake package), fresco-doc (pages, examples) and python3-fresco. Configure with -DCMAKE_INSTALL_PREFIX=/usr, so that
# libraries go to Debian's folder for them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME fresco)
set(CPACK_PACKAGE_VENDOR "The fresco authors")
set(CPACK_PACKAGE_CONTACT "The fresco authors <fresco@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_COMPONENTS_ALL runtime development documentation)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME fresco)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "libegl-mesa0, libgl1-mesa-dri") # loaded by libEGL when pictures are drawn
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
    "Libraries and command line tools that clean and register laser or RGB-D scans,\nreconstruct a watertight surface and \
texture it from calibrated photographs.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libfresco-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "fresco (= ${PROJECT_VERSION}-1), libpcl-dev (>= 1.12), libeigen3-dev (>= 3.4)")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers and CMake package of fresco: PCL-compatible classes.")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_NAME fresco-doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_COMPONENT_DOCUMENTATION_DESCRIPTION "Documentation and example programs of fresco.")
if(TARGET fresco_python) # what the module links, fresco links, too
  list(APPEND CPACK_COMPONENTS_ALL python)
  execute_process(COMMAND "${FRESCO_PYTHON}" -c "import sys; print('%d.%d' % sys.version_info[:2])"
                  OUTPUT_VARIABLE python_version OUTPUT_STRIP_TRAILING_WHITESPACE)
  string(REGEX REPLACE "^.*[.]" "" next_minor "${python_version}")
  math(EXPR next_minor "${next_minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-fresco)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "fresco (= ${PROJECT_VERSION}-1), python3 (>= ${python_version}), \
python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Python module of fresco: every stage from numpy arrays.")
endif()
include(CPack)
