#include "ayumi/io/run/run_folder.hpp"

#include <algorithm>
#include <exception>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/regular_file.hpp"
#include "ayumi/base/shortened_text.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/run/provenance_fields.hpp"
#include "ayumi/io/run/seal.hpp"
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
// Largest size of a file of a run [bytes]. Chosen: a log of half an hour at 1 kHz is smaller.
constexpr size_t kLargestRunFile = size_t{4} << 30;
// Largest size of a table of a run [bytes]: that of read_file().
constexpr size_t kLargestText = size_t{1} << 30;

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

[[noreturn]] void complain_of_change(const fs::path& file, const std::string& what) {
  fail(ErrorCode::bad_file, {file.string()},
       "the file has changed since the run was written, because " + what + "; make the run again");
}

constexpr const char* kOtherHash = "its SHA-256 differs from the value in run.json";

[[noreturn]] void complain_of_unlisted(const fs::path& file) {
  fail(ErrorCode::bad_file, {file.string()},
       "run.json does not list this file in \"files\", so the file belongs to another run or was "
       "changed; remove the file, or make the run again");
}

// Whether a name is that of a file in the folder itself.
bool is_file_name(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && fs::path(name).filename() == name;
}

bool is_log_name(const std::string& name) {
  return name.starts_with("log_") && name.ends_with(".bin");
}
bool is_table_name(const std::string& name) {
  return name == kReferenceFile || name == kPushedFile;
}

// A file of a run. The bytes that are hashed are those that are read.
class HashedFile {
 public:
  explicit HashedFile(const fs::path& path, size_t max_bytes = kLargestRunFile)
      : file_(path, max_bytes) {}
  size_t size() const { return file_.stated_size(); }
  std::string next(size_t count) {
    std::string bytes = file_.next(count);
    hash_.add(bytes);
    return bytes;
  }
  // The hash of the whole file. Nothing may be read afterwards.
  std::string digits() {
    constexpr size_t kPiece = size_t{1} << 20;  // chosen: calls of the system then cost nothing
    while (!next(kPiece).empty()) continue;
    return hash_.digits();
  }

 private:
  RegularFile file_;
  Sha256Stream hash_;
};

// The difference between the size of a file of a run and the one that its run.json records; empty
// if there is none. The size comes first, because it takes no time; runs of versions before 0.3.0
// have no sizes.
std::string other_size(const HashedFile& file, const JsonNode& root, const std::string& name) {
  const auto sizes = root.find(kSizesKey);
  const auto recorded = sizes ? sizes->find(name) : std::nullopt;
  if (!recorded || recorded->unsigned_integer() == file.size()) return "";
  return "it has " + std::to_string(file.size()) + " bytes, but run.json states " +
         std::to_string(recorded->unsigned_integer()) + " bytes";
}

// What `use` makes of a file of the run, after its bytes were compared with what run.json records.
template <typename Use>
auto use_unchanged(const fs::path& folder, const JsonNode& root, const std::string& name,
                   size_t max_bytes, const Use& use) {
  const fs::path path = folder / name;
  const auto recorded = root.at("files").find(name);
  if (!recorded) complain_of_unlisted(path);
  HashedFile file(path, max_bytes);
  if (const std::string what = other_size(file, root, name); !what.empty())
    complain_of_change(path, what);
  std::optional<decltype(use(file))> used;
  std::exception_ptr error;
  try {
    used = use(file);
  } catch (...) {  // that the file has changed is the better message
    error = std::current_exception();
  }
  if (recorded->string() != file.digits()) complain_of_change(path, kOtherHash);
  if (error) std::rethrow_exception(error);
  return *std::move(used);
}

std::string unchanged_text(const fs::path& folder, const JsonNode& root, const std::string& name) {
  return use_unchanged(folder, root, name, kLargestText,
                       [](HashedFile& file) { return file.next(file.size()); });
}

void require_unchanged(const fs::path& folder, const JsonNode& root, const std::string& name) {
  use_unchanged(folder, root, name, kLargestRunFile, [](HashedFile&) { return true; });
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
    if (root.has(kSealKey) && !is_sealed(text)) complain_of_change(path, kOtherHash);
  }
  // Throws unless the text has its own hash and the sizes of all files.
  void require_seal() const {
    const auto missing = [&](const std::string& member) {
      root().complain("the member '" + member +
                      "' is missing. The file has changed, or an older version of Ayumi wrote the "
                      "file; make the run again");
    };
    if (!is_sealed(text)) missing(kSealKey);
    const auto sizes = root().find(kSizesKey);
    if (!sizes) missing(kSizesKey);
    for (const auto& [name, hash] : root().at("files").members())
      if (!sizes->has(name)) missing(std::string(kSizesKey) + "/" + name);
  }
  // Throws unless run.json lists, with hash and size, every file that a reader takes for a part of
  // the run, and names no file outside of the folder. Otherwise a file would be read that no hash
  // binds to this run.
  void require_listed(const fs::path& folder) const {
    const JsonNode files = root().at("files");
    for (const auto& [name, hash] : files.members())
      if (!is_file_name(name))
        hash.complain("'" + text::quotable(name) +
                      "' is not the name of a file in this folder; make the run again");
    for (const auto& [name, log] : root().at("logs").members())
      if (const JsonNode file = log.at("file"); file.string() != log_file_name(name))
        file.complain("'" + text::quotable(file.string()) +
                      "' is not the file of this log; the file must be " + log_file_name(name) +
                      ". Make the run again");
      else if (!files.has(log_file_name(name)))
        complain_of_unlisted(folder / log_file_name(name));
    if (const auto sizes = root().find(kSizesKey))
      for (const auto& [name, size] : sizes->members())
        if (!files.has(name))
          size.complain("\"files\" has no file of this name; make the run again");
    // A run without tables may contain those that a person has exported from it.
    const bool light = root().has(kLightKey);
    std::error_code error;
    std::set<std::string> unlisted;  // so that the message does not depend on the order in a folder
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (const std::string name = entry.path().filename().string();
          !files.has(name) && (is_log_name(name) || (!light && is_table_name(name))))
        unlisted.insert(name);
    if (!unlisted.empty()) complain_of_unlisted(folder / *unlisted.begin());
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
  const std::string log = log_file_name(name);
  return use_unchanged(folder, root, log, kLargestRunFile, [&](HashedFile& file) {
    return read_log([&](size_t count) { return file.next(count); }, file.size(),
                    (folder / log).string());
  });
}

// The name of the log that is meant by `name`, which may be empty.
std::string chosen_log(const fs::path& folder, const std::vector<std::string>& names,
                       const std::string& name) {
  const SourcePlace place{(folder / kRunFile).string(), "/logs"};
  if (names.empty()) fail(ErrorCode::bad_file, place, "the run holds no simulation log");
  const auto has = [&](const std::string& log) {
    return std::find(names.begin(), names.end(), log) != names.end();
  };
  if (name.empty()) return has("closed_loop") ? "closed_loop" : names.front();
  if (!has(name))
    fail(ErrorCode::bad_file, place,
         "the run has no log '" + name + "'" + text::suggestion(name, names) +
             " (known: " + text::join(names, ", ") + ")");
  return name;
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
    if (is_file_name(name)) names.push_back(name);
  return names;
}

bool is_file_of_run(const fs::path& folder, const fs::path& file) {
  const RunFile run(folder);
  const JsonNode root = run.root();
  const std::string name = file.filename().string();
  const auto recorded = root.at("files").find(name);
  if (!recorded) return false;
  HashedFile bytes(file);
  return other_size(bytes, root, name).empty() && recorded->string() == bytes.digits();
}

std::optional<std::string> verify_run(const fs::path& folder, const std::string& keep) {
  const RunFile file(folder);
  const JsonNode root = file.root();
  file.require_listed(folder);
  file.require_seal();
  std::optional<std::string> kept;
  for (const auto& [name, hash] : root.at("files").members()) {
    if (name == keep)
      kept = unchanged_text(folder, root, name);
    else
      require_unchanged(folder, root, name);
  }
  return kept;
}

RunFolder read_run(const fs::path& folder, ComparedFiles compared) {
  const RunFile file(folder);
  const JsonNode root = file.root();
  file.require_listed(folder);
  if (compared == ComparedFiles::all) file.require_seal();
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
  std::set<std::string> read;
  for (const auto& [name, node] : root.at("logs").members()) {
    run.logs.emplace(name, log_of(folder, root, name));
    read.insert(log_file_name(name));
  }
  for (const auto& [name, hash] : root.at("files").members()) {
    if (name == kReferenceFile || name == kPushedFile) {
      const std::string text = unchanged_text(folder, root, name), path = (folder / name).string();
      const bool pushed = name == kPushedFile;
      (pushed ? run.pushed : run.reference) = parse_reference(text, path);
      (pushed ? run.pushed_caution : run.reference_caution) = parse_table_caution(text, path);
      continue;
    }
    if (compared == ComparedFiles::all && !read.contains(name))
      require_unchanged(folder, root, name);
    if (!name.starts_with("log_")) run.files.push_back(name);
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
  file.require_listed(path);
  const JsonNode root = file.root();
  std::vector<std::string> names;
  for (const auto& entry : root.at("logs").members()) names.push_back(entry.first);
  return log_of(path, root, chosen_log(path, names, name));
}

const SimulationLog& log_of_run(const RunFolder& run, const fs::path& folder,
                                const std::string& name) {
  std::vector<std::string> names;
  for (const auto& entry : run.logs) names.push_back(entry.first);
  return run.logs.at(chosen_log(folder, names, name));
}

}  // namespace ayumi
