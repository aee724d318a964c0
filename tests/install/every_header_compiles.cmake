# cmake -DSCRATCH= -DCOMPILER= -DEIGEN= -P every_header_compiles.cmake
# Every installed header alone, then all of them in one file, in this order and in the opposite one.
cmake_minimum_required(VERSION 3.25)
set(include ${SCRATCH}/stage/include)
file(GLOB_RECURSE headers RELATIVE ${include} ${include}/*.hpp)
list(LENGTH headers count)
if(count LESS 12)
  message(FATAL_ERROR "only ${count} headers are installed")
endif()

set(options -std=c++20 -Wall -Wextra -Werror -I${include} -isystem ${EIGEN})

function(compile name lines)
  file(WRITE ${SCRATCH}/headers/${name}.cpp "${lines}")
  execute_process(COMMAND ${COMPILER} ${options} -fsyntax-only ${ARGN} ${SCRATCH}/headers/${name}.cpp
                  RESULT_VARIABLE status ERROR_VARIABLE errors)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${name} does not compile:\n${errors}")
  endif()
endfunction()

# A header that includes one of these, itself or through others, is compiled after the first of them
# that it includes, which is parsed once for all of them. This hides nothing, because a header's
# includes stand above its first line of code, and a header that includes none of them is compiled
# without them.
set(parsed_once ayumi/check/consistency.hpp ayumi/sim/simulation_log.hpp ayumi/motion/pattern.hpp
    ayumi/model/robot_model.hpp Dense Geometry Core)
foreach(part ${parsed_once})
  cmake_path(GET part STEM name)
  set(line "<Eigen/${part}>")
  if(part MATCHES "^ayumi")
    set(line "\"${part}\"")
  endif()
  file(WRITE ${SCRATCH}/headers/${name}.hpp "#include ${line}\n")
  execute_process(COMMAND ${COMPILER} ${options} -x c++-header ${SCRATCH}/headers/${name}.hpp
                          -o ${SCRATCH}/headers/${name}.hpp.gch COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# includes(header): what a header includes, in place of "<Eigen/Core>" the word Core.
function(includes header)
  file(STRINGS ${include}/${header} lines REGEX "^#include [<\"](Eigen|ayumi)[^>\"]*[>\"]")
  list(TRANSFORM lines REPLACE "^#include [<\"](Eigen/)?([^>\"]*)[>\"].*" "\\2")
  set(includes ${lines} PARENT_SCOPE)
endfunction()

# included(header): what a header includes, itself or through others.
function(included header)
  set(seen)
  includes(${header})
  set(open ${includes})
  while(open)
    list(POP_FRONT open next)
    if(next IN_LIST seen)
      continue()
    endif()
    list(APPEND seen ${next})
    if(next MATCHES "^ayumi")
      includes(${next})
      list(APPEND open ${includes})
    endif()
  endwhile()
  set(seen ${seen} PARENT_SCOPE)
endfunction()

set(all)
set(opposite)
foreach(header ${headers})
  # Only Eigen shows in what is installed.
  file(STRINGS ${include}/${header} third REGEX "#include <[^>]*[/.]")
  foreach(line ${third})
    if(NOT line MATCHES "<Eigen/")
      message(FATAL_ERROR "${header}: ${line}: not a public header")
    endif()
  endforeach()
  included(${header})
  set(first)
  foreach(part ${parsed_once})
    if(NOT first AND part IN_LIST seen)
      cmake_path(GET part STEM name)
      set(first -Winvalid-pch -include ${SCRATCH}/headers/${name}.hpp)
    endif()
  endforeach()
  string(REPLACE "/" "_" name ${header})
  compile(${name} "#include \"${header}\"\n" ${first})
  set(all "${all}#include \"${header}\"\n")
  set(opposite "#include \"${header}\"\n${opposite}")
endforeach()
compile(all "${all}")
compile(opposite "${opposite}")
message("${count} headers")
