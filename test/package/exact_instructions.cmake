# Fails where a library has instructions whose results depend on the maker of the processor: estimates of 1/x and 1/sqrt(x).
#   cmake -D OBJDUMP=... -D LIBRARIES=a.so,b.so -P exact_instructions.cmake
string(REPLACE "," ";" libraries "${LIBRARIES}")
set(found "")
foreach(library IN LISTS libraries)
  execute_process(COMMAND "${OBJDUMP}" -d --no-show-raw-insn "${library}"
                  COMMAND grep -E "[[:space:]]v?(rsqrt|rcp)[0-9a-z]*[[:space:]]|^[0-9a-f]+ <.*>:$"
                  COMMAND grep -B1 -E "[[:space:]]v?(rsqrt|rcp)[0-9a-z]*[[:space:]]"
                  OUTPUT_VARIABLE lines RESULTS_VARIABLE status)
  list(GET status 0 dumped)
  if(NOT dumped EQUAL 0)
    message(FATAL_ERROR "${library} cannot be disassembled")
  endif()
  if(NOT lines STREQUAL "")
    string(APPEND found "${library}:\n${lines}")
  endif()
endforeach()
if(found)
  message(FATAL_ERROR "estimates, which differ between processors (is EIGEN_FAST_MATH 0?):\n${found}")
endif()
