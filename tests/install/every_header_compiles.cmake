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

# A header that includes this one, itself or through others, is compiled after it, so that it is parsed
# once for all of them. This hides nothing, because a header's includes stand above its first line of
# code. (More such headers, Eigen/Core among them, take longer to precompile than they save.)
set(parsed_once ayumi/model/robot_model.hpp)
file(WRITE ${SCRATCH}/headers/parsed_once.hpp "#include \"${parsed_once}\"\n")
execute_process(COMMAND ${COMPILER} ${options} -x c++-header ${SCRATCH}/headers/parsed_once.hpp
                        -o ${SCRATCH}/headers/parsed_once.hpp.gch COMMAND_ERROR_IS_FATAL ANY)

# `includes_<header>` lists what a header includes, with the word Core instead of "<Eigen/Core>".
foreach(header ${headers})
  file(STRINGS ${include}/${header} lines REGEX "^ *(#|[^/ ])")
  set(includes_${header})
  set(code FALSE)
  foreach(line IN LISTS lines)
    if(NOT line MATCHES "^#")
      set(code TRUE)
    elseif(line MATCHES "^#include")
      if(code)
        message(FATAL_ERROR "${header}: ${line}: an include stands below the first line of code")
      elseif(line MATCHES "^#include [<\"](Eigen/|ayumi/)([^>\"]*)[>\"]")
        string(REPLACE "Eigen/" "" part ${CMAKE_MATCH_1}${CMAKE_MATCH_2})
        list(APPEND includes_${header} ${part})
      elseif(line MATCHES "<[^>]*[/.]")  # only Eigen shows in what is installed
        message(FATAL_ERROR "${header}: ${line}: not a public header")
      endif()
    endif()
  endforeach()
endforeach()

# `seen_<header>` lists what a header includes, itself or through others. `order` lists headers,
# those that include less first.
set(order)
foreach(header ${headers})
  set(seen)
  set(open ${includes_${header}})
  while(open)
    list(POP_FRONT open next)
    if(NOT next IN_LIST seen)
      list(APPEND seen ${next})
      list(APPEND open ${includes_${next}})
    endif()
  endwhile()
  set(seen_${header} ${seen})
  list(LENGTH seen length)
  math(EXPR length "1000 + ${length}")
  list(APPEND order "${length} ${header}")
endforeach()
list(SORT order)

# Headers of which each includes the one before it are compiled in one file, in this order: the code
# before a header is then what it includes anyway. `chains` has the last header of each file.
set(chains)
foreach(entry ${order})
  string(REGEX REPLACE "^[0-9]* " "" header ${entry})
  set(options_${header})
  if(${parsed_once} IN_LIST seen_${header})
    set(options_${header} -Winvalid-pch -include ${SCRATCH}/headers/parsed_once.hpp)
  endif()
  set(before)
  foreach(last ${chains})
    if(last IN_LIST seen_${header} AND "${options_${last}}" STREQUAL "${options_${header}}")
      set(before ${last})  # the last one found includes most
    endif()
  endforeach()
  list(REMOVE_ITEM chains "${before}")
  list(APPEND chains ${header})
  set(lines_${header} "${lines_${before}}#include \"${header}\"\n")
endforeach()
foreach(last ${chains})
  string(REPLACE "/" "_" name ${last})
  compile(${name} "${lines_${last}}" ${options_${last}})
endforeach()

set(all)
set(opposite)
foreach(header ${headers})
  set(all "${all}#include \"${header}\"\n")
  set(opposite "#include \"${header}\"\n${opposite}")
endforeach()
compile(all "${all}")
compile(opposite "${opposite}")
list(LENGTH chains files)
message("${count} headers, in ${files} files")
