#include "ayumi/io/run/simulation_log_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>

#include "ayumi/base/file.hpp"
#include "ayumi/base/regular_file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/compression.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/pattern/scenario_text.hpp"
#include "ayumi/io/run/log_about.hpp"
#include "ayumi/io/run/log_fields.hpp"
#include "ayumi/io/run/provenance_fields.hpp"
#include "ayumi/io/run/sample_compression.hpp"
#include "ayumi/io/run/sha256_stream.hpp"
#include "ayumi/model/validate.hpp"
#include "ayumi/sim/log_events.hpp"

namespace ayumi {

namespace {

static_assert(std::endian::native == std::endian::little, "logs are little-endian");

constexpr char kMagic[] = "AYUMILOG";
constexpr std::uint32_t kPlain = 1;  // Definition: the version with uncompressed rows
// Definition: the version with compressed rows in one block. Version 2, in which no column is
// predicted from others, is read like this version.
constexpr std::uint32_t kCompressed = 3;
constexpr std::uint32_t kInBlocks = 4;  // Definition: the version with several blocks
constexpr size_t kPrefix = 16;          // magic, version, header length
// Size of the header's checksum, which logs with compressed rows have.
constexpr size_t kChecksum = 4;
// Largest size of the samples of a log [bytes]. Chosen: half an hour at 1 kHz takes less.
constexpr size_t kMostBytes = size_t{4} << 30;
// Largest size of a header [bytes]. Chosen: it leaves room for an event in every row.
constexpr size_t kLongestHeader = size_t{256} << 20;
constexpr const char* kOutcomes[] = {"stands", "unsettled", "fell"};

using OrderedJson = nlohmann::ordered_json;

class TakeValues {
 public:
  TakeValues(size_t joints, const char*& at) : joints_(joints), at_(at) {}
  void operator()(const std::string&, const char*, Eigen::Vector3d& v) const {
    for (double& value : v) value = take();
  }
  void operator()(const std::string&, const char*, Eigen::VectorXd& v) const {
    v.resize(static_cast<Eigen::Index>(joints_));
    for (double& value : v) value = take();
  }
  void operator()(const std::string& name, const char* unit, BasePose& base) const {
    (*this)(name, unit, base.position);
    Eigen::Quaterniond& q = base.attitude;
    for (double* const part : {&q.w(), &q.x(), &q.y(), &q.z()}) *part = take();
  }
  void operator()(const std::string&, const char*, double& value) const { value = take(); }
  void operator()(const std::string&, const char*, bool& value) const { value = take() != 0; }
  void operator()(const std::string&, const char*, LawStage& stage) const {
    const double number = take();
    const bool known = number >= 0 && number <= static_cast<double>(LawStage::settle);
    stage = known ? static_cast<LawStage>(static_cast<int>(number)) : LawStage::replay;
  }
  void operator()(const std::string&, const char*, int& value) const {
    const double number = take();
    value = std::abs(number) < 2e9 ? static_cast<int>(number) : 0;
  }

 private:
  double take() const {
    double value = 0;
    std::memcpy(&value, at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  size_t joints_;
  const char*& at_;
};

std::vector<std::string> columns_of(const std::vector<std::string>& joints) {
  std::vector<std::string> names;
  for (const LogQuantity& quantity : log_quantities(joints))
    for (size_t i = 0; i < quantity.columns(); ++i) names.push_back(quantity.column(i));
  return names;
}

int index_of(const JsonNode& node, const std::vector<std::string>& names) {
  const std::string name = node.one_of(names);
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

template <size_t N>
int index_of(const JsonNode& node, const char* const (&names)[N]) {
  return index_of(node, std::vector<std::string>(names, names + N));
}

// visit(key, figure) for every figure of the result, in file order.
template <typename Result, typename Visit>
void for_each_figure(Result& r, const Visit& visit) {
  visit("fell_at", r.fell_at);
  visit("max_tilt", r.max_tilt);
  visit("final_cog_error", r.final_cog_error);
  visit("final_speed", r.final_speed);
  visit("zmp_tracking_rms", r.zmp_tracking_rms);
  visit("zmp_amplitude", r.zmp_amplitude);
  visit("zmp_frequency", r.zmp_frequency);
  visit("flight", r.flight);
  visit("apex", r.apex);
  visit("steps", r.steps);
  visit("max_speed_ratio", r.speed.ratio);
  visit("max_torque_ratio", r.torque.ratio);
  visit("max_penetration", r.max_penetration);
  visit("max_slip", r.max_slip);
  visit("max_contact_residual", r.max_contact_residual);
  visit("max_contact_iterations", r.max_contact_iterations);
  visit("mean_contact_iterations", r.mean_contact_iterations);
}

// Calls visit(key, share) for the place of every share; files of versions that did not record it
// have none.
template <typename Result, typename Visit>
void for_each_place(Result& r, const Visit& visit) {
  visit("max_speed_at", r.speed);
  visit("max_torque_at", r.torque);
}

OrderedJson json_of(const SimulationResult& result, const std::vector<std::string>& joints) {
  OrderedJson json = {{"outcome", kOutcomes[static_cast<int>(result.outcome)]}};
  for_each_figure(result, [&](const char* key, auto figure) { json[key] = figure; });
  for_each_place(result, [&](const char* key, const JointShare& share) {
    if (share.joint >= 0)
      json[key] = {{"joint", joints.at(static_cast<size_t>(share.joint))}, {"t", share.at}};
  });
  return json;
}

SimulationResult result_of(const JsonNode& node, const std::vector<std::string>& joints) {
  SimulationResult result;
  for_each_place(result, [&](const char* key, JointShare& share) {
    const auto place = node.find(key);
    if (!place) return;
    const std::string joint = place->at("joint").one_of(joints);
    share.joint = static_cast<int>(std::find(joints.begin(), joints.end(), joint) - joints.begin());
    share.at = place->at("t").number();
  });
  result.outcome = static_cast<Outcome>(index_of(node.at("outcome"), kOutcomes));
  for_each_figure(result, [&](const char* key, auto& figure) {
    const JsonNode value = node.at(key);
    if constexpr (std::is_integral_v<std::decay_t<decltype(figure)>>) {
      figure = value.integer();
    } else {  // an infinite or undefined figure is null in JSON
      figure = value.value().is_null() ? NAN : value.number();
    }
  });
  return result;
}

std::string header_of(const SimulationLog& log, size_t rows, const std::string& command_line,
                      std::uint32_t version_of_file) {
  OrderedJson header = {{"format", "ayumi.log/" + std::to_string(version_of_file)}};
  header.update(about_log(log));
  header["provenance"]["command_line"] = command_line;
  // The gains are sorted by name. This is the order in which they are read back, so a log that was
  // read has the same hash.
  header["gains"] = OrderedJson::object();
  for (const auto& [name, value] : std::map(log.gains.begin(), log.gains.end()))
    header["gains"][name] = value;
  header["world"] = OrderedJson::parse(world_text(log.world, false));
  header["scenario"] = OrderedJson::array();
  for (const Disturbance& push : log.scenario)
    header["scenario"].push_back(OrderedJson::parse(disturbance_text(push, false)));
  header["events"] = OrderedJson::array();
  for (const SimulationEvent& event : log.events)
    header["events"].push_back(
        {{"t", event.t}, {"kind", name_of(event.kind)}, {"text", event.text}});
  header["result"] = json_of(log.result, log.joints);
  header["joints"] = log.joints;
  header["columns"] = columns_of(log.joints);
  header["rows"] = rows;
  if (version_of_file == kInBlocks) header["block_rows"] = kLogBlockRows;
  return header.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

void read_header(const JsonNode& header, SimulationLog& log) {
  log.dt = header.at("dt").number();
  if (!(log.dt >= kShortestServoPeriod && log.dt <= kLongestServoPeriod))
    header.at("dt").complain("the time between two samples is " + text::brief(log.dt) +
                             " s, but it must be from 1e-7 to 10 s");
  const JsonNode controller = header.at("controller");
  if (!controller.string().empty())
    log.controller = controller_type(controller.one_of(controller_names()));
  if (const auto plant = header.find("plant")) log.plant = plant->string();
  if (const auto gains = header.find("gains"))
    for (const auto& [name, value] : gains->members()) log.gains.emplace_back(name, value.number());
  const JsonNode provenance = header.at("provenance");
  for_each_provenance(log.provenance, [&](const char* key, std::string& value) {
    value = provenance.at(key).string();
  });
  PatternScope scope{.parameters = {}, .used = {}, .radians_per_unit = 1.0};
  log.world = read_world(header.at("world"), scope);
  for (const JsonNode& node : header.at("scenario").items())
    log.scenario.push_back(read_disturbance(node, scope));
  const JsonNode events = header.at("events");
  // Chosen: the program adds a few events of its own to those of the simulator, such as the case
  // of a study.
  constexpr size_t kMostOthers = 100;
  if (events.size() > kMostLogEvents + kMostOthers)
    events.complain("the log has " + std::to_string(events.size()) + " events, but at most " +
                    std::to_string(kMostLogEvents + kMostOthers) + " are read; simulate again");
  for (const JsonNode& node : events.items())
    log.events.push_back({node.at("t").number(),
                          static_cast<EventKind>(index_of(node.at("kind"), event_kind_names())),
                          node.at("text").string()});
  log.joints = header.at("joints").strings();
  log.result = result_of(header.at("result"), log.joints);
}

// These checks allow every reader of a log to trust its numbers.
void require_finite(std::string_view values, size_t first_row,
                    const std::vector<std::string>& columns,
                    const std::function<void(const std::string&)>& stop) {
  for (size_t i = 0; i < values.size() / sizeof(double); ++i) {
    double value = 0;
    std::memcpy(&value, values.data() + i * sizeof value, sizeof value);
    if (!std::isfinite(value))
      stop("the file is damaged: row " + std::to_string(first_row + i / columns.size()) +
           ", column '" + columns[i % columns.size()] + "' is not a finite number");
  }
}

std::uint32_t word_at(const std::string& bytes, size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

void append_word(std::string& bytes, std::uint32_t word) {
  bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

std::string prefix_of(std::uint32_t version_of_file, const std::string& header) {
  std::string bytes = kMagic;
  append_word(bytes, version_of_file);
  append_word(bytes, static_cast<std::uint32_t>(header.size()));
  return bytes;
}

std::string plain_head(const SimulationLog& log, size_t rows, const std::string& command_line) {
  const std::string header = header_of(log, rows, command_line, kPlain);
  return prefix_of(kPlain, header) + header;
}

// Number of rows that are converted at a time when a log is read or hashed. Chosen: they stay in
// the cache.
constexpr size_t kRowsAtATime = 64;

// Calls visit(rows) with the rows of the log as version 1 has them, a few at a time.
void for_rows_of(const SimulationLog& log, const std::function<void(const std::string&)>& visit) {
  std::string rows;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    append_values(log.samples[k], log.joints.size(), rows);
    if ((k + 1) % kRowsAtATime != 0 && k + 1 < log.samples.size()) continue;
    visit(rows);
    rows.clear();
  }
}

// Appends the rows that have been read.
void append_samples(std::string_view values, size_t joints, size_t rows,
                    std::vector<SimulationSample>& samples) {
  const char* at = values.data();
  const size_t before = samples.size();
  samples.resize(before + rows);
  for (size_t k = before; k < samples.size(); ++k)
    for_each_field(samples[k], TakeValues(joints, at));
}

// What the header says about the samples.
struct LogHead {
  SimulationLog log;  // without samples
  std::vector<std::string> columns;
  bool is_compressed = false;
  size_t begin = 0;  // where the samples begin in the file
  size_t rows = 0, block_rows = 0;
  size_t row_bytes() const { return columns.size() * sizeof(double); }
  size_t blocks() const { return rows <= block_rows ? 1 : (rows + block_rows - 1) / block_rows; }
  // Largest size of the samples in the file.
  size_t most_bytes() const {
    return is_compressed
               ? blocks() * largest_compressed_size(columns.size(), std::min(rows, block_rows))
               : rows * row_bytes();
  }
};

// Reads the part before the samples of a file of `size` bytes.
LogHead read_head(const NextBytes& next, size_t size, const std::string& file) {
  const auto stop = [&](const std::string& reason) { fail(ErrorCode::bad_file, {file}, reason); };
  const std::string prefix = next(kPrefix);
  if (prefix.empty()) stop("the file is empty, but a simulation log is needed");
  if (prefix.size() < kPrefix || prefix.compare(0, 8, kMagic) != 0)
    stop("this is not a simulation log; name a run folder or one of its .bin files");
  const std::uint32_t version_of_file = word_at(prefix, 8);
  if (version_of_file < kPlain || version_of_file > kInBlocks)
    stop("log version " + std::to_string(version_of_file) + " cannot be read; this " +
         "version of Ayumi reads " + std::to_string(kPlain) + " to " + std::to_string(kInBlocks));
  LogHead head;
  head.is_compressed = version_of_file != kPlain;
  const std::string checksum = next(head.is_compressed ? kChecksum : 0);
  const size_t length = word_at(prefix, 12);
  head.begin = kPrefix + checksum.size() + length;
  if (size < head.begin || (head.is_compressed && checksum.size() < kChecksum))
    stop("the file is truncated: the header is incomplete");
  if (length > kLongestHeader)
    stop("the file is damaged: the header has " + std::to_string(length) +
         " bytes; it may have at most " + std::to_string(kLongestHeader));
  const std::string text = next(length);
  if (head.is_compressed && word_at(checksum, 0) != crc32_of(text))
    stop("the file is damaged: the checksum of the header is wrong");
  const std::string place = file + " (header)";
  const Json document = parse_json(text, place, ErrorCode::bad_file);
  const JsonNode header = root_of(document, place, ErrorCode::bad_file);
  read_header(header, head.log);
  head.columns = columns_of(head.log.joints);
  if (header.at("columns").strings() != head.columns)
    header.at("columns").complain(
        "another version of Ayumi wrote this log, because its columns differ from the columns of "
        "this "
        "version; simulate again");
  head.rows = static_cast<size_t>(header.at("rows").unsigned_integer());
  if (head.rows > kMostBytes / head.row_bytes())
    header.at("rows").complain("a log may have at most " +
                               std::to_string(kMostBytes / head.row_bytes()) + " rows");
  head.block_rows = head.rows;
  if (version_of_file == kInBlocks) {
    const JsonNode stated = header.at("block_rows");
    head.block_rows = static_cast<size_t>(stated.unsigned_integer());
    if (head.block_rows == 0) stated.complain("a block must have at least 1 row");
  }
  return head;
}

// Reads the samples, which are the bytes of the file behind its header.
SimulationLog read_samples(LogHead head, std::string_view values, const std::string& file) {
  const auto stop = [&](const std::string& reason) { fail(ErrorCode::bad_file, {file}, reason); };
  SimulationLog log = std::move(head.log);
  const auto take = [&](std::string_view block, size_t count) {
    require_finite(block, log.samples.size(), head.columns, stop);
    append_samples(block, log.joints.size(), count, log.samples);
  };
  const size_t rows = head.rows, row_bytes = head.row_bytes();
  if (!head.is_compressed) {
    if (rows * row_bytes != values.size())
      stop(std::string("the file is ") +
           (rows * row_bytes > values.size() ? "truncated" : "damaged") + ": it has " +
           std::to_string(values.size()) + " bytes of samples, but the header announces " +
           std::to_string(rows) + " rows of " + std::to_string(row_bytes) + " bytes");
    take(values, rows);
    return log;
  }
  for (const std::string_view frame : sample_frames(values, head.blocks(), file)) {
    const size_t count = std::min(head.block_rows, rows - log.samples.size());
    log.samples.reserve(std::min(rows, 2 * (log.samples.size() + count)));
    take(decompress_samples(frame, head.columns.size(), count, file), count);
  }
  return log;
}

}  // namespace

size_t log_columns(const std::vector<std::string>& joints) { return columns_of(joints).size(); }

LogBlocks::LogBlocks(const std::vector<std::string>& joints, Write write)
    : joints_(joints.size()),
      columns_(log_columns(joints)),
      sources_(log_sources(joints)),
      write_(std::move(write)) {}

void LogBlocks::add(const SimulationSample& sample) {
  // A further block only begins when there is a row for it, so the last block is not empty.
  if (rows_in_block_ == kLogBlockRows) write_block();
  if (block_.empty()) block_.reserve(kLogBlockRows * columns_ * sizeof(double));
  append_values(sample, joints_, block_);
  ++rows_;
  ++rows_in_block_;
}

void LogBlocks::finish() { write_block(); }

void LogBlocks::write_block() {
  const size_t rows = std::exchange(rows_in_block_, 0);
  write_(compress_samples(std::exchange(block_, {}), columns_, sources_), rows);
}

std::string log_head(const SimulationLog& about, size_t rows) {
  const std::uint32_t version_of_file = rows > kLogBlockRows ? kInBlocks : kCompressed;
  const std::string header = header_of(about, rows, about.provenance.command_line, version_of_file);
  std::string bytes = prefix_of(version_of_file, header);
  append_word(bytes, crc32_of(header));
  return bytes + header;
}

std::string hashed_log_head(const SimulationLog& about, size_t rows) {
  return plain_head(about, rows, "");
}

std::string log_bytes(const SimulationLog& log) {
  std::string bytes = log_head(log, log.samples.size());
  LogBlocks blocks(log.joints, [&](const std::string& block, size_t) { bytes += block; });
  for (const SimulationSample& sample : log.samples) blocks.add(sample);
  blocks.finish();
  return bytes;
}

std::string plain_log_bytes(const SimulationLog& log) {
  std::string bytes = plain_head(log, log.samples.size(), log.provenance.command_line);
  for_rows_of(log, [&](const std::string& rows) { bytes += rows; });
  return bytes;
}

SimulationLog parse_log(const std::string& bytes, const std::string& file) {
  size_t at = 0;
  const auto next = [&](size_t count) {
    const std::string part = bytes.substr(at, count);
    at += part.size();
    return part;
  };
  LogHead head = read_head(next, bytes.size(), file);
  return read_samples(std::move(head), std::string_view(bytes).substr(at), file);
}

bool is_log_file(const std::filesystem::path& path) {
  try {
    RegularFile file(path, std::numeric_limits<size_t>::max());
    // To read some files of /proc, which state no size, would block.
    return file.stated_size() >= kPrefix && file.next(std::strlen(kMagic)) == kMagic;
  } catch (const Error&) {  // a file that cannot be read is no log
    return false;
  }
}

size_t most_log_rows(const std::vector<std::string>& joints) {
  return kMostBytes / (log_columns(joints) * sizeof(double));
}

SimulationLog read_log(const NextBytes& next, size_t size, const std::string& file) {
  LogHead head = read_head(next, size, file);
  // What the header does not announce is not read into memory.
  const size_t rest = size - head.begin;
  if (rest > head.most_bytes())
    fail(ErrorCode::bad_file, {file},
         "the file is damaged: it has " + std::to_string(rest) + " bytes of samples, but " +
             std::to_string(head.rows) + " rows have at most " + std::to_string(head.most_bytes()));
  const std::string values = next(rest);
  return read_samples(std::move(head), values, file);
}

SimulationLog read_log(const std::filesystem::path& path) {
  RegularFile file(path, kMostBytes);
  return read_log([&](size_t count) { return file.next(count); }, file.stated_size(),
                  path.string());
}

void write_log(const std::filesystem::path& path, const SimulationLog& log) {
  write_file(path, log_bytes(log));
}

std::string log_hash(const SimulationLog& log) {
  Sha256Stream hash;
  hash.add(hashed_log_head(log, log.samples.size()));
  for_rows_of(log, [&](const std::string& rows) { hash.add(rows); });
  return hash.digits();
}

}  // namespace ayumi
