# Fails where Doxygen had something to say: cmake -D WARNINGS=FILE -P site_warnings.cmake
file(READ "${WARNINGS}" text)
if(NOT text STREQUAL "")
  message(FATAL_ERROR "the documentation has mistakes:\n${text}")
endif()
