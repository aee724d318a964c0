# What makes a build from nothing quick.
#
# AYUMI_PRECOMPILE: the headers that nearly every source includes (Eigen, the standard library, and
#   those that a target names) are parsed once for each level of optimization, because g++ optimizes
#   what a precompiled header brings as the header was made.
# AYUMI_UNITY: several sources of a room (a folder of lib/ayumi) are compiled as one. A build from
#   nothing takes about a third of the time; after a change of one source its whole group is
#   compiled, and after a new source its room. The preset for daily work switches it off.
# Rooms that run in a loop (each tick of a simulation, each iteration of a repair) are compiled with
#   -O3. Warm ones, which call them and judge what they return, or draw, are compiled with -O1: check,
#   repair, push and retime take the same time. Cold ones read, write and talk to the user; with -Og
#   they compile in three quarters of the time of -O1. (A run with its clip takes 0.7 s longer of 15
#   if what draws is cold.)

option(AYUMI_PRECOMPILE "Precompile the headers that most sources include" ON)
option(AYUMI_UNITY "Compile several sources as one: quick from nothing, slower after a change" ON)
set(AYUMI_UNITY_SIZE 8 CACHE STRING "How many sources are compiled as one at -O3")
set(AYUMI_COLD_UNITY_SIZE 24 CACHE STRING "How many warm or cold sources are compiled as one")

# ayumi_compile_together(key size sources...): about this many of them as one, in groups of the same
# size. Groups of different keys stay apart, so that a new source moves no source of another key.
# Three groups of eight as one take 0.57 of the time at -O1, but 1.2 times as long at -O3, where the
# optimizer works on more functions at once: therefore two sizes.
function(ayumi_compile_together key size)
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

# g++ looks for garbage from 128 MB on, and a group of sources has 500 MB and more that are in use:
# from 1 GB on this is 6 to 9 % less time and 15 % more memory.
function(ayumi_collect_less_garbage target)
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)
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
  ayumi_collect_less_garbage(${target})
endfunction()

# The libraries are linked statically, so a function is the one that its own source defines, and may
# be inlined there although the code is position independent.
set(AYUMI_LIBRARY_OPTIONS -ffp-contract=off -fno-semantic-interposition)
# The tests are compiled as usual. Threads count without losing a count.
option(AYUMI_COVERAGE "The libraries and ayumi count the lines they execute (tests/coverage.sh)" OFF)
if(AYUMI_COVERAGE)
  list(APPEND AYUMI_LIBRARY_OPTIONS --coverage -fprofile-update=atomic)
  add_link_options(--coverage)
endif()

# ayumi_compile_with_heat(target HOT|WARM|COLD): for a target with AYUMI_LIBRARY_OPTIONS and position
# independent code.
set(AYUMI_HOT_OPTION)
set(AYUMI_WARM_OPTION $<$<CONFIG:Release>:-O1>)
set(AYUMI_COLD_OPTION $<$<CONFIG:Release>:-Og>)
set(AYUMI_HOT_HEADERS <Eigen/Dense>)
set(AYUMI_WARM_HEADERS <Eigen/Dense>)
set(AYUMI_COLD_HEADERS <Eigen/Dense> <nlohmann/json.hpp>)
function(ayumi_compile_with_heat target heat)
  target_compile_options(${target} PRIVATE ${AYUMI_${heat}_OPTION})
  ayumi_compile_quickly(${target} REUSE_FROM ayumi_${heat}_headers)
endfunction()
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/headers.cpp CONTENT "")
foreach(heat HOT WARM COLD)
  add_library(ayumi_${heat}_headers OBJECT ${CMAKE_CURRENT_BINARY_DIR}/headers.cpp)
  set_target_properties(ayumi_${heat}_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(ayumi_${heat}_headers PRIVATE Eigen3::Eigen Threads::Threads
                        nlohmann_json::nlohmann_json)
  target_compile_options(ayumi_${heat}_headers PRIVATE ${AYUMI_LIBRARY_OPTIONS}
                         ${AYUMI_${heat}_OPTION})
  ayumi_compile_quickly(ayumi_${heat}_headers ${AYUMI_${heat}_HEADERS})
endforeach()

# ayumi_link_hot_first(target libraries...): puts these libraries before the target's own objects.
# Several objects contain the same functions of templates (many of Eigen's), and the linker keeps the
# first copy of each. If a cold object came first, the hot rooms would run the copy that was compiled
# with -Og: check took 1.3 times as long. Builds without these levels keep the usual order.
function(ayumi_link_hot_first target)
  set(files ${ARGN})
  list(TRANSFORM files REPLACE "(.+)" "$<TARGET_FILE:\\1>")
  list(JOIN files " " files)
  target_link_options(${target} PRIVATE
    "SHELL:$<$<CONFIG:Release>:-Wl,--whole-archive ${files} -Wl,--no-whole-archive>")
endfunction()
