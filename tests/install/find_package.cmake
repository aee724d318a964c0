# cmake -DCONSUMER= -DSCRATCH= -DGENERATOR= -DCOMPILER= -DCONFIG= -DFLAGS= -P find_package.cmake
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

cmake_path(GET CONSUMER FILENAME name)
set(build ${SCRATCH}/${name})
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${build} -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${SCRATCH}/stage -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_FLAGS_DEBUG=${FLAGS})
run(${CMAKE_COMMAND} --build ${build})
run(${build}/consumer ${SCRATCH}/stage/share/ayumi)
message("${output}")
