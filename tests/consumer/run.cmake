# Installs the build into a folder of its own, then builds and runs the consumer against it.
# Fails when a header, a dependency or the package's files are missing from the installation.
function(step)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(folder ${BUILD}/tests/consumer)
file(REMOVE_RECURSE ${folder})
step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${folder}/prefix --config ${CONFIG})
step(${CMAKE_COMMAND} -S ${SOURCE} -B ${folder}/build -G ${GENERATOR}
     -D CMAKE_BUILD_TYPE=${CONFIG} -D CMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS}"
     -D CMAKE_PREFIX_PATH=${folder}/prefix)
step(${CMAKE_COMMAND} --build ${folder}/build)
step(${folder}/build/consumer)
step(${folder}/prefix/bin/parallux --version)
