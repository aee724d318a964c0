# Compares the suites of a test program with those that CTest runs: -DPROGRAM= -DSUITES=a;b;c
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE output
                COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\." found "${output}")
foreach(suite ${found})
  string(REGEX REPLACE "[\n.]" "" suite "${suite}")
  # Suites with values have names such as Prefix/Suite, and typed suites have names such as Suite/0.
  string(REGEX REPLACE "/[0-9]+$" "" suite "${suite}")
  string(REGEX REPLACE "^.*/" "" suite "${suite}")
  if(NOT suite IN_LIST SUITES)
    message(FATAL_ERROR "${PROGRAM}: the suite '${suite}' is not run by CTest; write its TEST "
                        "macros at the beginning of a line")
  endif()
endforeach()
