# CMake package: find_package(fresco COMPONENTS core io image search filters surface registration tracking alignment texture deliverables model).
include(CMakePackageConfigHelpers)
set(config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/fresco")
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/frescoConfig.cmake.in" "${PROJECT_BINARY_DIR}/frescoConfig.cmake"
                              INSTALL_DESTINATION "${config_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/frescoConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/frescoConfig.cmake" "${PROJECT_BINARY_DIR}/frescoConfigVersion.cmake"
              "${PROJECT_SOURCE_DIR}/cmake/FindOpenCV.cmake"
        DESTINATION "${config_dir}" COMPONENT development)
install(EXPORT frescoTargets NAMESPACE fresco:: DESTINATION "${config_dir}" COMPONENT development)
install(FILES "${PROJECT_SOURCE_DIR}/package.xml" DESTINATION "${CMAKE_INSTALL_DATADIR}/fresco" COMPONENT development)
# README's links lead to the pages and examples beside it, and theirs back.
install(FILES "${PROJECT_SOURCE_DIR}/README.md" "${PROJECT_SOURCE_DIR}/CHANGELOG.md" "${PROJECT_SOURCE_DIR}/CONTRIBUTING.md"
        DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/fresco" COMPONENT documentation)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs" "${PROJECT_SOURCE_DIR}/examples"
        DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/fresco" COMPONENT documentation
        PATTERN "site" EXCLUDE PATTERN ".ipynb_checkpoints" EXCLUDE)
