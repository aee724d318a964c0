// Motions in the formats of other programs. The first line of an input is the name of the format;
// if it is empty, the content decides. A motion that was read is written in the same format.

#include "ayumi/io/formats/motion_formats.hpp"
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  const std::string_view all(reinterpret_cast<const char*>(data), size);
  const size_t line = std::min(all.find('\n'), size);
  ImportOptions options;
  options.format = all.substr(0, line);
  if (!options.format.empty() && !find_motion_format(options.format)) return 0;
  // The separator of files occurs inside binary formats.
  const std::string_view content = all.substr(std::min(line + 1, size));
  auto parts = fuzz::parts_of(content);
  const MotionFormat* format = find_motion_format(options.format);
  if (format && format->binary) parts = {{"", std::string(content)}};
  const fuzz::InputFolder folder(parts, "motion.dat");
  const std::string file = folder.path("motion.dat").string();
  options.by_order = size % 2;
  options.rate = 50;
  ImportedMotion motion;
  if (!fuzz::accepts([&] { motion = read_motion(parts[0].bytes, file, fuzz::hoap1(), options); }))
    return 0;
  fuzz::expect(motion.motion.theta.allFinite(), "the angles of a motion are finite");
  fuzz::expect(motion.motion.theta.rows() > 0, "a motion has rows");
  return 0;
}
