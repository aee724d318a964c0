# What makes a build from nothing quick.
#
# AYUMI_PRECOMPILE: the headers that nearly every source includes (Eigen, the standard library, and
#   those that a target names) are parsed once. The libraries that name no further headers share
#   what ayumi_core has parsed. It costs a rebuild nothing.
# AYUMI_UNITY: several sources of a room are compiled as one. A build from nothing takes about a
#   third of the time; after a change of one source its whole group is compiled, and after a new
#   source its room. The preset for daily work switches it off.

option(AYUMI_PRECOMPILE "Precompile the headers that most sources include" ON)
option(AYUMI_UNITY "Compile several sources as one: quick from nothing, slower after a change" ON)
set(AYUMI_UNITY_SIZE 8 CACHE STRING "How many sources are compiled as one")

# ayumi_compile_together(key sources...): about AYUMI_UNITY_SIZE of them as one, in groups of the same
# size. Groups of different keys stay apart, so that a new source moves no source of another key.
function(ayumi_compile_together key)
  list(FILTER ARGN INCLUDE REGEX "[.]cpp$")
  list(LENGTH ARGN count)
  math(EXPR groups "(2 * ${count} + ${AYUMI_UNITY_SIZE}) / (2 * ${AYUMI_UNITY_SIZE})")
  if(groups EQUAL 0)
    set(groups 1)
  endif()
  set(index 0)
  foreach(source ${ARGN})
    math(EXPR group "${index} * ${groups} / ${count}")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${key}_${group})
    math(EXPR index "${index} + 1")
  endforeach()
endfunction()

# ayumi_compile_quickly(target headers...): headers in angle brackets, beyond the standard library; or
# REUSE_FROM and a target that is compiled with the same options.
function(ayumi_compile_quickly target)
  if(AYUMI_PRECOMPILE AND "${ARGV1}" STREQUAL "REUSE_FROM")
    target_precompile_headers(${target} REUSE_FROM ${ARGV2})
  elseif(AYUMI_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <functional> <map>
                              <memory> <optional> <string> <utility> <vector> ${ARGN})
  endif()
  if(AYUMI_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  endif()
endfunction()
