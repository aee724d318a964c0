# cmake -DSOURCE= -DSCRATCH= -DGENERATOR= -DCOMPILER= -DCONFIG= -DFLAGS= -P push_and_export.cmake
# Builds examples/push_and_export on what was installed and runs it as its first line says.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

set(build ${SCRATCH}/push_and_export)
set(share ${SCRATCH}/stage/share/ayumi)
set(table ${build}/table.csv)
run(${CMAKE_COMMAND} -S ${SOURCE}/examples/push_and_export -B ${build} -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${SCRATCH}/stage -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_FLAGS_DEBUG=${FLAGS})
run(${CMAKE_COMMAND} --build ${build})
file(REMOVE ${table})
run(${build}/push_and_export ${share}/patterns/hoap1_walk.json ${share}/robots ${table})
foreach(expected "hoap1_walk on hoap1: consistent" "pushed forwards with 0.8 N s: stands")
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "the program does not print \"${expected}\":\n${output}")
  endif()
endforeach()
# The head of the table names what the table was made from.
file(STRINGS ${table} head REGEX "^# ")
foreach(line "# robot: hoap1" "# pattern: hoap1_walk" "# controller: dtad")
  if(NOT line IN_LIST head)
    message(FATAL_ERROR "the head of the table has no line \"${line}\":\n${head}")
  endif()
endforeach()

# A robot that cannot be found is an error with its own exit code, and no table is written.
file(REMOVE ${table})
execute_process(
  COMMAND ${build}/push_and_export ${share}/patterns/hoap1_walk.json ${build}/nowhere ${table}
  RESULT_VARIABLE status ERROR_VARIABLE message OUTPUT_QUIET)
if(NOT status EQUAL 3 OR NOT message MATCHES "hoap1" OR EXISTS ${table})
  message(FATAL_ERROR "expected exit code 3, the robot's name and no table, got ${status}:\n${message}")
endif()
