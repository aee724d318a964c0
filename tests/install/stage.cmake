# cmake -DBUILD= -DSCRATCH= -P stage.cmake
file(REMOVE_RECURSE ${SCRATCH})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/stage
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${SCRATCH}/stage/bin/ayumi --version COMMAND_ERROR_IS_FATAL ANY)
