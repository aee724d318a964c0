// Run folders: run.json, then tables and logs. Fingerprints are corrected to fit, so that the code
// behind their check is reached.

#include <nlohmann/json.hpp>

#include "ayumi/base/file.hpp"
#include "ayumi/io/run/run_results.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "fuzz_target.hpp"

namespace {

using Json = nlohmann::ordered_json;

void make_fingerprints_fit(std::vector<ayumi::fuzz::Part>& parts) {
  Json run = Json::parse(parts[0].bytes, nullptr, false);
  if (!run.is_object() || !run.contains("files") || !run["files"].is_object()) return;
  for (const ayumi::fuzz::Part& part : parts)
    if (run["files"].contains(part.name)) run["files"][part.name] = ayumi::sha256(part.bytes);
  run.erase("file_bytes");
  run.erase("contents_sha256");
  std::string text = run.dump(2, ' ', false, Json::error_handler_t::replace);
  text.resize(text.rfind("\n}"));
  parts[0].bytes = text + ",\n  \"contents_sha256\": \"" + ayumi::sha256(text) + "\"\n}\n";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  auto parts = fuzz::parts_of({reinterpret_cast<const char*>(data), size});
  make_fingerprints_fit(parts);
  const fuzz::InputFolder folder(parts, "run.json");
  const auto path = folder.path("");
  fuzz::accepts([&] { verify_run(path); });
  fuzz::accepts([&] { run_file_names(path); });
  fuzz::accepts([&] { read_run_log(path); });
  fuzz::accepts([&] { read_run_section(path, "check"); });
  RunFolder run;
  if (fuzz::accepts([&] { run = read_run(path); }))
    fuzz::accepts([&] { read_results(run, "run.json"); });
  return 0;
}
