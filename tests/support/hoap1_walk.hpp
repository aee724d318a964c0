#pragma once
// The bundled walk of HOAP-1 as most tests use it: it is sampled once.

#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {

inline const CommandSeries& hoap1_walk() {
  static const CommandSeries series =
      sample(hoap1(), read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json"));
  return series;
}

}  // namespace ayumi::test
