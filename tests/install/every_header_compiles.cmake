# cmake -DSCRATCH= -DCOMPILER= -DEIGEN= -P every_header_compiles.cmake
# Every installed header alone, then all of them in one file, in this order and in the opposite one.
set(include ${SCRATCH}/stage/include)
file(GLOB_RECURSE headers RELATIVE ${include} ${include}/*.hpp)
list(LENGTH headers count)
if(count LESS 12)
  message(FATAL_ERROR "only ${count} headers are installed")
endif()

function(compile name lines)
  file(WRITE ${SCRATCH}/headers/${name}.cpp "${lines}")
  execute_process(
    COMMAND ${COMPILER} -std=c++20 -fsyntax-only -Wall -Wextra -Werror -I${include} -isystem ${EIGEN}
            ${SCRATCH}/headers/${name}.cpp
    RESULT_VARIABLE status ERROR_VARIABLE errors)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${name} does not compile:\n${errors}")
  endif()
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
  string(REPLACE "/" "_" name ${header})
  compile(${name} "#include \"${header}\"\n")
  set(all "${all}#include \"${header}\"\n")
  set(opposite "#include \"${header}\"\n${opposite}")
endforeach()
compile(all "${all}")
compile(opposite "${opposite}")
message("${count} headers")
