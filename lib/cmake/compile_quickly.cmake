# Settings that shorten a full build.
#
# AYUMI_PRECOMPILE: the headers that nearly every source includes (Eigen, the standard library, and
#   those that a target names) are parsed once for each level of optimization, because g++ compiles
#   the functions of a precompiled header at the level at which the header was made.
# AYUMI_UNITY: several sources of a room (a folder of lib/ayumi) are compiled as one. A full build
#   takes about a third of the time. After a change of one source its whole group is compiled, and
#   after a new source its whole room. The preset for daily work switches it off.
# Hot rooms, which run in a loop (each tick of a simulation, each iteration of a repair), are
#   compiled with -O3. Warm rooms, which call the hot ones and judge their results, or draw, are
#   compiled with -O1: check, repair, push and retime take the same time. Cold rooms read, write and
#   talk to the user; with -Og they compile in three quarters of the time of -O1. (If the rooms that
#   draw were cold, a run with its clip, which takes 15 s, would take 0.7 s longer.)

option(AYUMI_PRECOMPILE "Precompile the headers that most sources include" ON)
option(AYUMI_UNITY "Compile several sources as one: quick from nothing, slower after a change" ON)
set(AYUMI_UNITY_SIZE 8 CACHE STRING "How many sources are compiled as one at -O3")
set(AYUMI_COLD_UNITY_SIZE 24 CACHE STRING "How many warm or cold sources are compiled as one")

# ayumi_compile_together(key size sources...) compiles about `size` sources as one, in groups of equal
# size. Groups of different keys are separate, so that a new source moves no source of another key.
# If three groups of eight are compiled as one, this takes 0.57 of the time at -O1, but 1.2 times the
# time at -O3, where the optimizer works on more functions at once. Therefore there are two sizes.
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

# g++ begins to collect garbage at 128 MB, but a group of sources uses 500 MB and more at one time. If
# it begins at 1 GB, a compilation takes 6 to 9 % less time and 15 % more memory.
function(ayumi_collect_less_garbage target)
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)
endfunction()

# ayumi_compile_quickly(target headers...): the headers, in angle brackets, are precompiled in addition
# to those of the standard library. In place of headers, REUSE_FROM and another target may be given,
# which is compiled with the same options.
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

# ayumi_compile_with_heat(target HOT|WARM|COLD) sets the level of optimization of a target that has
# AYUMI_LIBRARY_OPTIONS and position independent code.
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
