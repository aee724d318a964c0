#include "ayumi/io/run/run_folder.hpp"

#include "ayumi/base/file.hpp"
#include "ayumi/base/regular_file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/run/provenance_fields.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/run/sha256_stream.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "ayumi/io/table/table.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr const char* kRunFormat = "ayumi.run/1";
constexpr const char* kRunFile = "run.json";
constexpr const char* kReferenceFile = "reference.csv";
constexpr const char* kPushedFile = "reference_pushed.csv";
constexpr const char* kLightKey = "light";
constexpr const char* kSizesKey = "file_bytes";
constexpr const char* kSealKey = "contents_sha256";
// Largest size of a file of a run [bytes]. Chosen: a log of half an hour at 1 kHz is smaller.
constexpr size_t kLargestRunFile = size_t{4} << 30;

size_t size_of(const fs::path& file) { return RegularFile(file, kLargestRunFile).stated_size(); }

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder) && !fs::is_directory(folder))
    fail(ErrorCode::bad_file, {folder.string()},
         "this is a file, but a folder is needed; choose another name");
  fs::create_directories(folder, error);
  if (error)
    fail(ErrorCode::bad_file, {folder.string()},
         "the folder cannot be made (" + error.message() + ")");
}

OrderedJson json_of(const TableCaution& caution) {
  return {{"disturbances", caution.disturbances}, {"unfit", caution.unfit}};
}

TableCaution caution_of(const JsonNode& node) {
  return {node.at("disturbances").string(), node.at("unfit").string()};
}

OrderedJson summary_of(const RunFolder& run, const std::map<std::string, std::string>& hashes,
                       const fs::path& folder) {
  OrderedJson json = {{"format", kRunFormat}, {"tool", std::string("ayumi ") + version()}};
  OrderedJson provenance;
  for_each_provenance(run.provenance,
                      [&](const char* key, const std::string& value) { provenance[key] = value; });
  json["provenance"] = provenance;
  for (const auto& [key, text] : run.sections) {
    require(!json.contains(key), "a section of run.json appears twice");
    json[key] = OrderedJson::parse(text);
  }
  json["unfit"] = run.unfit;
  if (run.light)
    json[kLightKey] = {{"reference", json_of(run.reference_caution)},
                       {"reference_pushed", json_of(run.pushed_caution)}};
  json["logs"] = OrderedJson::object();
  const auto entry = [](const std::string& name, const SimulationLog& log,
                        const std::string& hash) -> OrderedJson {
    return {{"file", log_file_name(name)},
            {"controller", log.controller ? name_of(*log.controller) : ""},
            {"log_hash", hash}};
  };
  std::map<std::string, OrderedJson> logs;  // logs in the order of their names
  for (const auto& [name, log] : run.written) logs[name] = entry(name, log.about, log.log_hash);
  for (const auto& [name, log] : run.logs)
    if (!run.written.contains(name)) logs[name] = entry(name, log, log_hash(log));
  for (const auto& [name, log] : logs) json["logs"][name] = log;
  json["files"] = hashes;
  json[kSizesKey] = OrderedJson::object();
  for (const auto& [name, hash] : hashes) json[kSizesKey][name] = size_of(folder / name);
  return json;
}

// The last member of run.json is the SHA-256 of the text before it.
std::string seal_before(const std::string& text) {
  return std::string(",\n  \"") + kSealKey + "\": \"" + sha256(text) + "\"\n}\n";
}

std::string sealed(const std::string& object) {
  const std::string text = object.substr(0, object.rfind("\n}"));
  return text + seal_before(text);
}

[[noreturn]] void complain_of_change(const fs::path& file, const std::string& what) {
  fail(ErrorCode::bad_file, {file.string()},
       "the file has changed since the run was written (" + what +
           " in run.json); make the run again");
}

constexpr const char* kOtherHash = "its SHA-256 differs from the value";

// The difference between a file of a run and what its run.json records; empty if there is none. The
// size comes first, because it takes no time; runs of versions before 0.3.0 have no sizes.
std::string difference(const fs::path& file, const JsonNode& root, const JsonNode& hash,
                       const std::string& name) {
  const auto sizes = root.find(kSizesKey);
  if (const auto recorded = sizes ? sizes->find(name) : std::nullopt) {
    const size_t size = size_of(file);
    if (recorded->unsigned_integer() != size)
      return "it has " + std::to_string(size) + " bytes, but " +
             std::to_string(recorded->unsigned_integer());
  }
  return hash.string() == sha256_of_file(file, kLargestRunFile) ? "" : kOtherHash;
}

// Files that run.json does not list are not compared.
void require_unchanged(const fs::path& folder, const JsonNode& root, const std::string& name) {
  const auto recorded = root.at("files").find(name);
  if (!recorded) return;
  const std::string what = difference(folder / name, root, *recorded, name);
  if (!what.empty()) complain_of_change(folder / name, what);
}

// The parsed run.json with its root.
struct RunFile {
  explicit RunFile(const fs::path& folder)
      : path((folder / kRunFile).string()),
        text(read(folder)),
        document(parse_json(text, path, ErrorCode::bad_file)) {
    const JsonNode root = this->root();
    root.expect_object();
    const std::string format = root.at("format").string();
    if (format != kRunFormat)
      root.at("format").complain("'" + format + "' cannot be read; this version of Ayumi reads '" +
                                 kRunFormat + "'");
    // Runs of versions before 0.2.0 are not sealed.
    if (root.has(kSealKey) && !is_sealed()) complain_of_change(path, kOtherHash);
  }
  bool is_sealed() const {
    const size_t at = text.rfind(std::string(",\n  \"") + kSealKey + "\"");
    return at != std::string::npos && text.substr(at) == seal_before(text.substr(0, at));
  }
  JsonNode root() const { return root_of(document, path, ErrorCode::bad_file); }

  static std::string read(const fs::path& folder) {
    if (!fs::exists(folder))
      fail(ErrorCode::bad_file, {folder.string()},
           "no such folder; a RUN is needed (the folder "
           "that `ayumi run` or `ayumi simulate` wrote)");
    if (!is_run_folder(folder))
      fail(ErrorCode::bad_file, {folder.string()},
           "the folder has no run.json; a RUN is needed (the "
           "folder that `ayumi run` or `ayumi simulate` wrote)");
    return read_file(folder / kRunFile);
  }

  std::string path, text;
  Json document;
};

SimulationLog log_of(const fs::path& folder, const JsonNode& root, const std::string& name) {
  const std::string file = root.at("logs").at(name).at("file").string();
  require_unchanged(folder, root, file);
  return read_log(folder / file);
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
  for (const auto& [name, log] : run.written) hashes[log_file_name(name)] = log.file_hash;
  for (const auto& [name, log] : run.logs)
    if (!run.written.contains(name)) write(log_file_name(name), log_bytes(log));
  if (run.reference && !run.light)
    write(kReferenceFile, reference_csv(*run.reference, run.reference_caution));
  if (run.pushed && !run.light) write(kPushedFile, reference_csv(*run.pushed, run.pushed_caution));
  for (const std::string& name : run.files)
    hashes[name] = sha256_of_file(folder / name, kLargestRunFile);
  write_file(folder / kRunFile, sealed(summary_of(run, hashes, folder).dump(2)));
}

std::vector<std::string> run_file_names(const fs::path& folder) {
  const RunFile file(folder);
  std::vector<std::string> names = {kRunFile};
  for (const auto& [name, hash] : file.root().at("files").members())
    if (fs::path(name).filename() == name && name != "." && name != "..") names.push_back(name);
  return names;
}

bool is_file_of_run(const fs::path& folder, const fs::path& file) {
  const RunFile run(folder);
  const JsonNode root = run.root();
  const std::string name = file.filename().string();
  const auto recorded = root.at("files").find(name);
  return recorded && difference(file, root, *recorded, name).empty();
}

void verify_run(const fs::path& folder) {
  const RunFile file(folder);
  const JsonNode root = file.root();
  if (!file.is_sealed())
    root.complain(std::string("the member '") + kSealKey +
                  "' is missing: the file has changed, or an older version wrote it; make the run "
                  "again");
  for (const auto& [name, hash] : root.at("files").members()) require_unchanged(folder, root, name);
}

RunFolder read_run(const fs::path& folder) {
  const RunFile file(folder);
  const JsonNode root = file.root();
  RunFolder run;
  const JsonNode provenance = root.at("provenance");
  for_each_provenance(run.provenance, [&](const char* key, std::string& value) {
    value = provenance.at(key).string();
  });
  if (root.has("unfit")) run.unfit = root.at("unfit").strings();
  if (const auto light = root.find(kLightKey)) {
    run.light = true;
    run.reference_caution = caution_of(light->at("reference"));
    run.pushed_caution = caution_of(light->at("reference_pushed"));
  }
  for (const auto& [name, node] : root.at("logs").members())
    run.logs.emplace(name, log_of(folder, root, name));
  for (const auto& [name, hash] : root.at("files").members()) {
    if (name == kReferenceFile || name == kPushedFile) {
      require_unchanged(folder, root, name);
      const bool pushed = name == kPushedFile;
      (pushed ? run.pushed : run.reference) = read_reference(folder / name);
      (pushed ? run.pushed_caution : run.reference_caution) = read_table_caution(folder / name);
    } else if (!name.starts_with("log_")) {
      run.files.push_back(name);
    }
  }
  for (const auto& [key, node] : root.members())
    if (key != "format" && key != "tool" && key != "provenance" && key != "logs" &&
        key != "files" && key != "unfit" && key != kLightKey && key != kSizesKey && key != kSealKey)
      run.sections.emplace_back(key, node.value().dump(2));
  return run;
}

std::string read_run_section(const fs::path& path, const std::string& key) {
  if (fs::is_regular_file(path)) return "";
  const RunFile file(path);
  const auto section = file.root().find(key);
  return section ? section->value().dump(2) : "";
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
    root.at("logs").complain("the run has no log '" + chosen + "'" +
                             text::suggestion(chosen, names) + " (" + text::join(names, ", ") +
                             ")");
  return log_of(path, root, chosen);
}

}  // namespace ayumi
