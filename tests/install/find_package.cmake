# cmake -DCONSUMER= -DSCRATCH= -DGENERATOR= -DCOMPILER= -DCONFIG= -DFLAGS= -P find_package.cmake
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGV}\nfailed (${status}):\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

cmake_path(GET CONSUMER FILENAME name)
set(build ${SCRATCH}/${name})
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${build} -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${SCRATCH}/stage -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_FLAGS_DEBUG=${FLAGS})
run(${CMAKE_COMMAND} --build ${build})
run(${build}/consumer ${SCRATCH}/stage/share/ayumi)
message("${output}")
