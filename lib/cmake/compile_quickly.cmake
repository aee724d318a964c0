# What makes a build from nothing quick.
#
# AYUMI_PRECOMPILE: the headers that nearly every source includes (Eigen, the standard library, and
#   those that a target names) are parsed once for each target. It costs a rebuild nothing.
# AYUMI_UNITY: several sources of a target are compiled as one. A build from nothing takes about a
#   third of the time; after a change of one source its whole group is compiled. The preset for
#   daily work switches it off.

option(AYUMI_PRECOMPILE "Precompile the headers that most sources include" ON)
option(AYUMI_UNITY "Compile several sources as one: quick from nothing, slower after a change" ON)
set(AYUMI_UNITY_SIZE 8 CACHE STRING "How many sources are compiled as one")

# ayumi_compile_quickly(target headers...): headers in angle brackets, beyond the standard library.
function(ayumi_compile_quickly target)
  if(AYUMI_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <functional> <map>
                              <memory> <optional> <string> <utility> <vector> ${ARGN})
  endif()
  if(AYUMI_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${AYUMI_UNITY_SIZE})
  endif()
endfunction()
