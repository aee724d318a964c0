#include "ayumi/io/run/run_folder.hpp"

#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/run/provenance_fields.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "ayumi/io/table/table.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kRunFormat = "ayumi.run/1";
constexpr const char* kRunFile = "run.json";
constexpr const char* kReferenceFile = "reference.csv";
constexpr size_t kLargestFile = size_t{4} << 30;  // [bytes]

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder) && !fs::is_directory(folder))
    fail(ErrorCode::bad_file, folder.string() + ": exists and is not a folder");
  fs::create_directories(folder, error);
  if (error)
    fail(ErrorCode::bad_file, folder.string() + ": cannot be made (" + error.message() + ")");
}

OrderedJson summary_of(const RunFolder& run, const std::map<std::string, std::string>& hashes) {
  OrderedJson json = {{"format", kRunFormat}, {"tool", std::string("ayumi ") + version()}};
  OrderedJson provenance;
  for_each_provenance(run.provenance,
                      [&](const char* key, const std::string& value) { provenance[key] = value; });
  json["provenance"] = provenance;
  for (const auto& [key, text] : run.sections) {
    require(!json.contains(key), "a section of run.json appears twice");
    json[key] = OrderedJson::parse(text);
  }
  json["logs"] = OrderedJson::object();
  for (const auto& [name, log] : run.logs)
    json["logs"][name] = {{"file", log_file_name(name)},
                          {"controller", log.controller ? name_of(*log.controller) : ""},
                          {"log_hash", log_hash(log)}};
  json["files"] = hashes;
  return json;
}

std::string checked_bytes(const fs::path& folder, const JsonNode& files, const std::string& name) {
  const std::string bytes = read_file(folder / name, kLargestFile);
  const auto recorded = files.find(name);
  if (recorded && recorded->string() != sha256(bytes))
    fail(ErrorCode::bad_file, (folder / name).string() +
                                  ": has changed since the run was written (its SHA-256 is not the "
                                  "one in run.json)");
  return bytes;
}

// run.json, parsed, with its root.
struct RunFile {
  explicit RunFile(const fs::path& folder)
      : path((folder / kRunFile).string()),
        document(parse_json(read(folder), path, ErrorCode::bad_file)) {
    const JsonNode root = this->root();
    root.expect_object();
    const std::string format = root.at("format").string();
    if (format != kRunFormat)
      root.at("format").complain("'" + format + "' is not readable here; this version reads '" +
                                 kRunFormat + "'");
  }
  JsonNode root() const { return root_of(document, path, ErrorCode::bad_file); }

  static std::string read(const fs::path& folder) {
    if (!fs::exists(folder))
      fail(ErrorCode::bad_file, folder.string() +
                                    ": no such folder; a RUN is needed (the folder "
                                    "that `ayumi run` or `ayumi simulate` wrote)");
    if (!is_run_folder(folder))
      fail(ErrorCode::bad_file, folder.string() +
                                    ": holds no run.json; a RUN is needed (the "
                                    "folder that `ayumi run` or `ayumi simulate` wrote)");
    return read_file(folder / kRunFile);
  }

  std::string path;
  Json document;
};

SimulationLog log_of(const fs::path& folder, const JsonNode& root, const std::string& name) {
  const std::string file = root.at("logs").at(name).at("file").string();
  return parse_log(checked_bytes(folder, root.at("files"), file), (folder / file).string());
}

}  // namespace

bool is_run_folder(const fs::path& path) {
  return fs::is_directory(path) && fs::exists(path / kRunFile);
}

std::string log_file_name(const std::string& name) { return "log_" + name + ".bin"; }

void write_run(const fs::path& folder, const RunFolder& run) {
  make_folder(folder);
  std::map<std::string, std::string> hashes;
  const auto write = [&](const std::string& name, const std::string& bytes) {
    write_file(folder / name, bytes);
    hashes[name] = sha256(bytes);
  };
  for (const auto& [name, log] : run.logs) write(log_file_name(name), log_bytes(log));
  if (run.reference) write(kReferenceFile, reference_csv(*run.reference));
  for (const std::string& name : run.files)
    hashes[name] = sha256(read_file(folder / name, kLargestFile));
  write_file(folder / kRunFile, summary_of(run, hashes).dump(2) + "\n");
}

RunFolder read_run(const fs::path& folder) {
  const RunFile file(folder);
  const JsonNode root = file.root();
  RunFolder run;
  const JsonNode provenance = root.at("provenance");
  for_each_provenance(run.provenance, [&](const char* key, std::string& value) {
    value = provenance.at(key).string();
  });
  for (const auto& [name, node] : root.at("logs").members())
    run.logs.emplace(name, log_of(folder, root, name));
  for (const auto& [name, hash] : root.at("files").members()) {
    if (name == kReferenceFile) {
      checked_bytes(folder, root.at("files"), name);
      run.reference = read_reference(folder / name);
    } else if (!name.starts_with("log_")) {
      run.files.push_back(name);
    }
  }
  for (const auto& [key, node] : root.members())
    if (key != "format" && key != "tool" && key != "provenance" && key != "logs" && key != "files")
      run.sections.emplace_back(key, node.value().dump(2));
  return run;
}

SimulationLog read_run_log(const fs::path& path, const std::string& name) {
  if (fs::is_regular_file(path)) return read_log(path);
  const RunFile file(path);
  const JsonNode root = file.root();
  std::vector<std::string> names;
  for (const auto& entry : root.at("logs").members()) names.push_back(entry.first);
  if (names.empty()) root.at("logs").complain("the run holds no simulation log");
  std::string chosen = name;
  if (chosen.empty()) chosen = root.at("logs").has("closed_loop") ? "closed_loop" : names.front();
  if (!root.at("logs").has(chosen))
    root.at("logs").complain("no log '" + chosen + "' in this run" +
                             text::suggestion(chosen, names) + " (" + text::join(names, ", ") +
                             ")");
  return log_of(path, root, chosen);
}

}  // namespace ayumi
