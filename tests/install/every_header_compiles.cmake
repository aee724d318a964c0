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

# A header that includes a part of Eigen, itself or through others, is compiled after that part, which
# is parsed once for all of them (half of the time of this test). This hides nothing, because a header's
# includes stand above its first line of code, and a header without Eigen is compiled without it.
foreach(part Core Geometry Dense)
  file(WRITE ${SCRATCH}/headers/${part}.hpp "#include <Eigen/${part}>\n")
  execute_process(COMMAND ${COMPILER} ${options} -x c++-header ${SCRATCH}/headers/${part}.hpp
                          -o ${SCRATCH}/headers/${part}.hpp.gch COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# includes(header): what a header includes, in place of "<Eigen/Core>" the word Core.
function(includes header)
  file(STRINGS ${include}/${header} lines REGEX "^#include [<\"](Eigen|ayumi)[^>\"]*[>\"]")
  list(TRANSFORM lines REPLACE "^#include [<\"](Eigen/)?([^>\"]*)[>\"].*" "\\2")
  set(includes ${lines} PARENT_SCOPE)
endfunction()

function(parts_of_eigen header)
  set(seen)
  set(open ${header})
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
  parts_of_eigen(${header})
  set(first)
  foreach(part Dense Geometry Core)
    if(NOT first AND part IN_LIST seen)
      set(first -Winvalid-pch -include ${SCRATCH}/headers/${part}.hpp)
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
