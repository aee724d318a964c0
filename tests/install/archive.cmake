# cmake -DSOURCE= -DSCRATCH= -P archive.cmake
# The archive can be unpacked anywhere and runs with an empty environment. Of all its shared
# libraries only those of libc are from the system.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

set(folder ${SCRATCH}/archive)
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder}/unpacked ${folder}/small)
# The archive is not compressed, because xz takes a minute for its libraries.
run(${CMAKE_COMMAND} -E env COMPRESS=cat ${SOURCE}/packaging/archive.sh ${SCRATCH}/stage ${folder})
file(GLOB archive ${folder}/ayumi-*-linux-*.tar)
run(tar --extract --directory ${folder}/unpacked --file ${archive})
file(GLOB root ${folder}/unpacked/ayumi-*)

# This is the compressed archive that users get, with one small folder only.
run(${CMAKE_COMMAND} -E env ONLY=bin ${SOURCE}/packaging/archive.sh ${SCRATCH}/stage ${folder}/small)
file(GLOB small ${folder}/small/ayumi-*-linux-*.tar.xz)
run(tar --list --xz --file ${small})
if(NOT output MATCHES "bin/ayumi")
  message(FATAL_ERROR "the compressed archive has no program:\n${output}")
endif()

run(env -i PATH=/usr/bin:/bin ${root}/bin/ayumi check ${root}/share/ayumi/patterns/hoap1_walk.json)
if(NOT output MATCHES "hoap1_walk.json: consistent")
  message(FATAL_ERROR "the unpacked program does not check a bundled pattern:\n${output}")
endif()
file(GLOB system_osmesa /usr/lib/*/libOSMesa.so.*)
file(GLOB osmesa ${root}/lib/libOSMesa.so.*)
if(system_osmesa AND NOT osmesa)
  message(FATAL_ERROR "the archive lacks OSMesa, which the first picture loads")
endif()
file(GLOB programs ${root}/lib/ayumi/* ${root}/lib/libOSMesa.so.*)
foreach(program ${programs})
  run(env LD_LIBRARY_PATH=${root}/lib ldd ${program})
  string(REGEX MATCHALL "=> [^\n(]*" places "${output}")
  foreach(place ${places})
    if(NOT place MATCHES "=> ${root}/lib/"
       AND NOT place MATCHES "/(libc|libm|libmvec|libdl|librt|libpthread|libresolv)\\.so")
      message(FATAL_ERROR "${program} takes a library from the system:\n${place}")
    endif()
  endforeach()
endforeach()
file(REMOVE_RECURSE ${folder})
