# cmake -DBUILD= -DSCRATCH= -P packages.cmake
# The Debian packages can be made, lintian finds no error in them, and each contains the files for
# its purpose. Ends with "skipped" where dpkg-shlibdeps or lintian is missing.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
find_program(lintian lintian)
find_program(shlibdeps dpkg-shlibdeps)
if(NOT lintian OR NOT shlibdeps)
  message("skipped: lintian and dpkg-dev are needed")
  return()
endif()
set(packages ${SCRATCH}/packages)
file(REMOVE_RECURSE ${packages})
# gzip is used instead of xz, which takes five times as long.
run(${CMAKE_CPACK_COMMAND} --config ${BUILD}/CPackConfig.cmake -G DEB -B ${packages}
    -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip)
file(GLOB debs ${packages}/*.deb)
run(${lintian} --allow-root --fail-on error ${debs})
foreach(pair "ayumi_;/usr/bin/ayumi\n" "ayumi_;/usr/share/ayumi/patterns/hoap1_walk.json"
        "ayumi_;/usr/share/man/man1/ayumi.1.gz" "libayumi-dev_;/libayumi_core.a"
        "libayumi-dev_;/ayumiConfig.cmake" "ayumi-doc_;/docs/tutorial.md")
  list(GET pair 0 name)
  list(GET pair 1 file)
  file(GLOB deb ${packages}/${name}*.deb)
  run(dpkg-deb --contents ${deb})
  if(NOT output MATCHES "${file}")
    message(FATAL_ERROR "${deb} has no ${file}:\n${output}")
  endif()
endforeach()
file(GLOB deb ${packages}/libayumi-dev_*.deb)
run(dpkg-deb --field ${deb} Description)
if(NOT output MATCHES "^library for motion patterns of humanoid robots\n Headers")
  message(FATAL_ERROR "${deb} has another description than its own:\n${output}")
endif()
