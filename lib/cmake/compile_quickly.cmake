# What makes a build from nothing quick.
#
# AYUMI_PRECOMPILE: the headers that nearly every source includes (Eigen, the standard library, and
#   those that a target names) are parsed once. The libraries share two sets of them: what ayumi_core
#   has parsed, and for cold code that of ayumi_cold_headers. It costs a rebuild nothing.
# AYUMI_UNITY: several sources of a room are compiled as one. A build from nothing takes about a
#   third of the time; after a change of one source its whole group is compiled, and after a new
#   source its room. The preset for daily work switches it off.
# Cold code, which computes nothing in a loop, is compiled with -O1. Its precompiled headers are made
#   with -O1 too, because g++ optimizes what they bring as they were made.

option(AYUMI_PRECOMPILE "Precompile the headers that most sources include" ON)
option(AYUMI_UNITY "Compile several sources as one: quick from nothing, slower after a change" ON)
set(AYUMI_UNITY_SIZE 8 CACHE STRING "How many sources are compiled as one")
set(AYUMI_COLD_UNITY_SIZE 24 CACHE STRING "How many sources of cold code are compiled as one")

# ayumi_compile_together(key [COLD] sources...): about AYUMI_UNITY_SIZE of them as one, in groups of the
# same size. Groups of different keys stay apart, so that a new source moves no source of another key.
# COLD: about AYUMI_COLD_UNITY_SIZE. Three groups of eight as one take 0.57 of the time at -O1, but
# 1.2 times as long at -O3, where the optimizer works on more functions at once.
function(ayumi_compile_together key)
  set(size ${AYUMI_UNITY_SIZE})
  if("${ARGV1}" STREQUAL "COLD")
    set(size ${AYUMI_COLD_UNITY_SIZE})
  endif()
  list(FILTER ARGN INCLUDE REGEX "[.]cpp$")
  list(LENGTH ARGN count)
  math(EXPR groups "(2 * ${count} + ${size}) / (2 * ${size})")
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
  # g++ looks for garbage from 128 MB on, and a group of sources has 500 MB and more that are in use:
  # from 1 GB on this is 6 to 9 % less time and 15 % more memory.
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)
endfunction()

# The libraries are linked statically, so a function is the one that its own source defines, and may
# be inlined there although the code is position independent.
set(AYUMI_LIBRARY_OPTIONS -ffp-contract=off -fno-semantic-interposition)

# ayumi_compile_cold(target): for a target with AYUMI_LIBRARY_OPTIONS and position independent code.
function(ayumi_compile_cold target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  ayumi_compile_quickly(${target} REUSE_FROM ayumi_cold_headers)
endfunction()
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/cold_headers.cpp CONTENT "")
add_library(ayumi_cold_headers OBJECT ${CMAKE_CURRENT_BINARY_DIR}/cold_headers.cpp)
set_target_properties(ayumi_cold_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_link_libraries(ayumi_cold_headers PRIVATE Eigen3::Eigen Threads::Threads
                      nlohmann_json::nlohmann_json)
target_compile_options(ayumi_cold_headers PRIVATE ${AYUMI_LIBRARY_OPTIONS}
                       $<$<CONFIG:Release>:-O1>)
ayumi_compile_quickly(ayumi_cold_headers <Eigen/Dense> <nlohmann/json.hpp>)
