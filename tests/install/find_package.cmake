# cmake -DBUILD= -DCONSUMER= -DSCRATCH= -DGENERATOR= -DCOMPILER= -DCONFIG= -DFLAGS= -P find_package.cmake
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGV}\nfailed (${status}):\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/stage)

# Only Eigen shows in what is installed.
file(GLOB_RECURSE headers ${SCRATCH}/stage/include/*.hpp)
foreach(header ${headers})
  file(STRINGS ${header} includes REGEX "#include <[^>]*[/.]")
  foreach(line ${includes})
    if(NOT line MATCHES "<Eigen/")
      message(FATAL_ERROR "${header}: ${line}: not a public header")
    endif()
  endforeach()
endforeach()

run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${SCRATCH}/build -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${SCRATCH}/stage -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_FLAGS_DEBUG=${FLAGS})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/consumer ${SCRATCH}/stage/share/ayumi)
message("${output}")
run(${SCRATCH}/stage/bin/ayumi --version)
message("${output}")
