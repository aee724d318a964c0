# cmake -DSCRATCH= -DPYTHON= -P installed.cmake
# What was installed works by itself, from a folder outside of the sources: the bundled robots and
# patterns are those of the installation, shells complete the commands, the manual page is valid,
# and Python imports the package.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

# The variables of a developer's shell name the data and the mesh reader of a build. Without a cache
# of meshes, the installed program needs its own mesh reader.
unset(ENV{AYUMI_DATA})
unset(ENV{AYUMI_MESH_READER})
set(ENV{XDG_CACHE_HOME} off)

set(stage ${SCRATCH}/stage)
set(elsewhere ${SCRATCH}/elsewhere)
file(REMOVE_RECURSE ${elsewhere})
file(MAKE_DIRECTORY ${elsewhere})

function(expect text what)
  if(NOT output MATCHES "${text}")
    message(FATAL_ERROR "${what}: \"${text}\" is missing in\n${output}")
  endif()
endfunction()

# The installation is copied to another place: nothing may depend on where the build meant to
# install it.
set(copy ${elsewhere}/moved)
file(COPY ${stage}/bin ${stage}/share ${stage}/libexec DESTINATION ${copy})
run(${CMAKE_COMMAND} -E chdir ${elsewhere} ${copy}/bin/ayumi check patterns/hoap1_walk.json)
expect("hoap1_walk.json: consistent" "a bundled pattern by its name")
run(${CMAKE_COMMAND} -E chdir ${elsewhere} ${copy}/bin/ayumi robots)
expect("hoap1" "the bundled robots")
run(${CMAKE_COMMAND} -E chdir ${elsewhere} ${copy}/bin/ayumi inspect hoap1)
expect("20 DOF" "a robot with meshes")
# The bill of materials names what the program names, and the licence of the code that the pages
# contain is there.
run(${CMAKE_COMMAND} -E chdir ${elsewhere} ${copy}/bin/ayumi --version)
set(versions "${output}")
file(READ ${copy}/share/doc/ayumi/ayumi.cdx.json bill)
string(JSON last LENGTH "${bill}" components)
math(EXPR last "${last} - 1")
foreach(i RANGE ${last})
  string(JSON name GET "${bill}" components ${i} name)
  string(JSON number GET "${bill}" components ${i} version)
  string(JSON licence GET "${bill}" components ${i} licenses 0 expression)
  string(FIND "${versions}" "${name} ${number}" at)
  if(at LESS 0 OR licence STREQUAL "")
    message(FATAL_ERROR "ayumi.cdx.json: ${name} ${number} (${licence}) is not in\n${versions}")
  endif()
endforeach()
string(JSON name GET "${bill}" metadata component name)
if(NOT name STREQUAL "ayumi" OR last LESS 15)
  message(FATAL_ERROR "ayumi.cdx.json is not the bill of materials of ayumi:\n${bill}")
endif()
if(versions MATCHES "three.js" AND NOT EXISTS ${copy}/share/doc/ayumi/three.js-LICENSE)
  message(FATAL_ERROR "the licence of three.js is not installed")
endif()
# The copy reads meshes by the program beside it: if another program is there, it says so.
find_program(another_program false REQUIRED)
file(COPY_FILE ${another_program} ${copy}/libexec/ayumi/ayumi-mesh-reader)
execute_process(COMMAND ${copy}/bin/ayumi inspect hoap1 ERROR_VARIABLE output RESULT_VARIABLE code
                OUTPUT_QUIET WORKING_DIRECTORY ${elsewhere})
expect("${copy}/libexec/ayumi/ayumi-mesh-reader: this program, which reads meshes, ended before it was ready"
       "a broken reader of meshes (exit code ${code})")

run(bash -c [=[source "$0"
COMP_WORDS=(ayumi new walk --str) COMP_CWORD=3
_ayumi
echo "[${COMPREPLY[*]}]"
COMP_WORDS=(ayumi ex) COMP_CWORD=1
_ayumi
echo "[${COMPREPLY[*]}]"]=]
    ${stage}/share/bash-completion/completions/ayumi)
expect("\\[--stride\\]" "completion of an option of bash")
expect("\\[export explain\\]|\\[explain export\\]" "completion of a command of bash")
find_program(zsh zsh)
if(zsh)
  run(${zsh} -n ${stage}/share/zsh/vendor-completions/_ayumi)
endif()
find_program(fish fish)
if(fish)
  run(${fish} --no-execute ${stage}/share/fish/vendor_completions.d/ayumi.fish)
endif()
find_program(man man)
if(man)
  run(bash -c "LC_ALL=C.UTF-8 MANWIDTH=120 '${man}' --warnings -l '${stage}/share/man/man1/ayumi.1.gz' 2>&1")
  expect("ayumi new walk.*--stride" "the manual page")
  if(output MATCHES "warning:")
    message(FATAL_ERROR "the manual page has warnings:\n${output}")
  endif()
endif()

if(PYTHON)
  file(GLOB_RECURSE package ${stage}/*/_native*.so)
  cmake_path(GET package PARENT_PATH folder)
  cmake_path(GET folder PARENT_PATH folder)
  run(${CMAKE_COMMAND} -E chdir ${elsewhere} ${CMAKE_COMMAND} -E env PYTHONPATH=${folder}
      ${PYTHON} -c "import ayumi\nprint(ayumi.data_folder('robots'), bool(ayumi.check(ayumi.load_task(ayumi.data_folder('patterns') / 'hoap1_walk.json'))))")
  expect("${stage}/share/ayumi/robots True" "the Python package")
endif()
