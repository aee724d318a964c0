#include "sweep/results_database.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "terminal.hpp"

namespace ayumi::app {

namespace fs = std::filesystem;

namespace {

/// Mark in the head of the file, "AYUM", by which other programs recognize it. Definition.
constexpr int kApplication = 0x4159554d;
/// Version of the tables, the views and the seal. Definition: every change of their SQL requires
/// another number, because a file with other tables or views is refused. Version 1 had no seal.
constexpr int kDatabaseFormat = 2;
/// Key of the seal of the rows in the table "about". Definition.
constexpr const char* kSealRow = "rows_sha256";
/// Longest text or row in a file [bytes]. Definition: a study file of 64 MiB, and room for the
/// rest.
constexpr int kLongestText = 65 << 20;
constexpr const char* kNoResults =
    "this file does not contain results of ayumi sweep, or the file is damaged. Choose another "
    "name";
/// Time for which a reader waits for a writer [ms]. Chosen: a commit takes a few ms.
constexpr int kLockPatience = 10000;

/// What SQLite says about its last error. It may quote names of the file, which may be long.
std::string said_by(sqlite3* database) {
  // Largest length [bytes]. Chosen: two rows of a terminal.
  constexpr size_t kMost = 160;
  return shortened(sqlite3_errmsg(database), kMost);
}

/// A prepared statement.
class Statement {
 public:
  Statement(sqlite3* database, const std::string& sql) {
    code_ = sqlite3_prepare_v2(database, sql.c_str(), -1, &statement_, nullptr);
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  bool good() const { return code_ == SQLITE_OK && statement_ != nullptr; }
  sqlite3_stmt* get() const { return statement_; }
  /// Moves to the next row. Returns false if there is none.
  bool step() {
    code_ = sqlite3_step(statement_);
    return code_ == SQLITE_ROW;
  }
  bool done() const { return code_ == SQLITE_DONE; }
  void reset() { sqlite3_reset(statement_); }
  void bind(int place, const Cell& cell) {
    if (const auto* const number = std::get_if<double>(&cell))
      sqlite3_bind_double(statement_, place, *number);
    else if (const auto* const word = std::get_if<std::string>(&cell))
      sqlite3_bind_text(statement_, place, word->data(), static_cast<int>(word->size()),
                        SQLITE_TRANSIENT);
    else
      sqlite3_bind_null(statement_, place);
  }
  void bind(int place, long value) { sqlite3_bind_int64(statement_, place, value); }
  std::string text(int column) const {
    const auto* const bytes =
        reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    return bytes ? std::string(bytes, static_cast<size_t>(sqlite3_column_bytes(statement_, column)))
                 : std::string();
  }
  long integer(int column) const { return sqlite3_column_int64(statement_, column); }
  /// The cell as in the CSV: the shortest number that gives the same double again, or the text.
  std::string cell(int column) const {
    if (sqlite3_column_type(statement_, column) == SQLITE_FLOAT)
      return text::exact(sqlite3_column_double(statement_, column));
    return text(column);
  }
  int columns() const { return sqlite3_column_count(statement_); }
  /// The cells of the row as the seal counts them: the kind of each cell and its value.
  std::string row_bytes() const {
    std::string bytes;
    for (int i = 0; i < columns(); ++i) {
      switch (sqlite3_column_type(statement_, i)) {
        case SQLITE_NULL:
          bytes += 'n';
          break;
        case SQLITE_INTEGER:
          bytes += 'i' + std::to_string(integer(i)) + ';';
          break;
        case SQLITE_FLOAT: {
          std::array<char, sizeof(double)> number;
          const double value = sqlite3_column_double(statement_, i);
          std::memcpy(number.data(), &value, sizeof value);
          bytes += 'd' + std::string(number.data(), number.size());
          break;
        }
        default: {
          const std::string word = text(i);
          bytes += 't' + std::to_string(word.size()) + ';' + word;
        }
      }
    }
    return bytes;
  }

 private:
  sqlite3_stmt* statement_ = nullptr;
  int code_ = SQLITE_OK;
};

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// All columns of a row, in their order.
std::vector<std::string> all_columns(const SweepHead& head) {
  std::vector<std::string> names = {"case"};
  for (const std::string& axis : head.axes) names.push_back(axis);
  names.emplace_back("error");
  for (const ResultColumn& column : head.columns) names.push_back(column.name);
  return names;
}

std::string list_of(const std::vector<std::string>& names, const std::string& before = "") {
  std::vector<std::string> quoted;
  for (const std::string& name : names) quoted.push_back(before + sql_name(name));
  return text::join(quoted, ", ");
}

}  // namespace

std::string sql_name(const std::string& name) {
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string sql_text(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

namespace {

/// The tables that describe the study and list the shards.
constexpr const char* kHeadTables =
    "CREATE TABLE about (key TEXT PRIMARY KEY, value TEXT) WITHOUT ROWID;"
    "CREATE TABLE inputs (place INTEGER PRIMARY KEY, kind TEXT, name TEXT, sha256 TEXT);"
    "CREATE TABLE axes (place INTEGER PRIMARY KEY, name TEXT, type TEXT);"
    "CREATE TABLE figures (place INTEGER PRIMARY KEY, name TEXT, type TEXT);"
    "CREATE TABLE shards (shard TEXT PRIMARY KEY) WITHOUT ROWID;";

/// The table of the cases, and the views.
std::string case_tables(const SweepHead& head) {
  std::string columns = "\"case\" INTEGER PRIMARY KEY";
  for (size_t i = 0; i < head.axes.size(); ++i)
    columns += ", " + sql_name(head.axes[i]) + " " + head.axis_types[i];
  columns += ", error TEXT";
  for (const ResultColumn& column : head.columns)
    columns += ", " + sql_name(column.name) + " " + column.type;
  std::string sql = "CREATE TABLE cases (" + columns + ");";
  std::string rates;
  for (size_t i = 0; i < head.axes.size(); ++i)
    rates += (i ? " UNION ALL " : "") + std::string("SELECT ") + std::to_string(i) + " AS place, " +
             sql_text(head.axes[i]) + " AS axis, " + sql_name(head.axes[i]) +
             " AS value, COUNT(outcome) AS runs, TOTAL(outcome = 'fell') AS falls, "
             "TOTAL(outcome = 'unsettled') AS unsettled, COUNT(error) AS errors, "
             "TOTAL(outcome <> 'stands') / COUNT(outcome) AS failure_rate FROM cases GROUP BY " +
             sql_name(head.axes[i]);
  std::string extremes;
  for (const ResultColumn& c : head.columns) {
    if (c.type != "REAL") continue;
    for (const char* what : {"min", "avg", "max"})
      extremes += ", " + std::string(what) + "(" + sql_name(c.name) + ") AS " +
                  sql_name((std::string(what) == "avg" ? "mean" : what) + ("_" + c.name));
  }
  bool judged = false;
  for (const ResultColumn& c : head.columns) judged = judged || c.name == "consistent";
  sql +=
      "CREATE VIEW summary AS SELECT (SELECT CAST(value AS INTEGER) FROM about WHERE key = "
      "'cases') AS cases, COUNT(*) AS done, COUNT(error) AS errors, "
      "CAST(SUM(outcome = 'stands') AS INTEGER) AS stands, "
      "CAST(SUM(outcome = 'fell') AS INTEGER) AS falls, "
      "CAST(SUM(outcome = 'unsettled') AS INTEGER) AS unsettled, "
      "CAST(SUM(outcome <> 'stands') AS INTEGER) AS failures, "
      "TOTAL(outcome <> 'stands') / COUNT(outcome) AS failure_rate, " +
      std::string(judged ? "CAST(TOTAL(consistent = 0) AS INTEGER)" : "NULL") + " AS inconsistent" +
      extremes +
      " FROM cases;"
      "CREATE VIEW failed AS SELECT * FROM cases WHERE error IS NOT NULL OR outcome <> 'stands';"
      "CREATE VIEW worst AS SELECT * FROM cases WHERE severity IS NOT NULL ORDER BY severity DESC, "
      "\"case\";";
  if (!rates.empty()) sql += "CREATE VIEW rates AS " + rates + ";";
  return sql;
}

}  // namespace

std::string SweepHead::fingerprint() const {
  std::string all = version + "\n" + seed + "\n" + std::to_string(cases) + "\n";
  for (const SweepInput& input : inputs)
    all += input.kind + "\n" + input.name + "\n" + input.sha256 + "\n";
  return sha256(all);
}

SweepHead head_of(const CaseRunner& runner, std::uint64_t seed) {
  const SweepStudy& study = runner.study();
  SweepHead head = {.name = study.name(),
                    .study_file = study.file().filename().string(),
                    .study_text = study.text(),
                    .version = version(),
                    .seed = std::to_string(seed),
                    .cases = study.size(),
                    .axes = study.axes(),
                    .columns = runner.columns(),
                    .inputs = runner.inputs()};
  for (const std::string& axis : head.axes)
    head.axis_types.push_back(
        std::holds_alternative<std::string>(study.named().at(axis).value) ? "TEXT" : "REAL");
  return head;
}

void ResultsDatabase::complain(const std::string& doing) const {
  const int code = database_ ? sqlite3_errcode(database_) : SQLITE_NOMEM;
  // A quota, or a limit on the size of files, appears as an error of writing. A reader needs space,
  // too, for the memory that it shares with writers.
  const int detail = database_ ? sqlite3_extended_errcode(database_) : SQLITE_OK;
  const bool unwritten = detail == SQLITE_IOERR_WRITE || detail == SQLITE_IOERR_SHMSIZE ||
                         detail == SQLITE_IOERR_FSYNC;
  std::string why = database_ ? said_by(database_) : "out of memory";
  if (code == SQLITE_FULL || unwritten)
    why =
        "the disk is full, or the system does not let the file grow. What was written before is "
        "kept. Make room and run the same command again to continue";
  else if (code == SQLITE_NOTADB || code == SQLITE_CORRUPT)
    why = kNoResults;
  else if (code == SQLITE_BUSY)
    why = "another program is writing to this file. Wait until that program has ended";
  fail(ErrorCode::bad_file, {file_.string()}, doing + ": " + why);
}

void ResultsDatabase::execute(const std::string& sql) const {
  if (sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    complain("the results cannot be written");
}

void ResultsDatabase::open(int flags) {
  if (sqlite3_open_v2(file_.c_str(), &database_, flags | SQLITE_OPEN_NOMUTEX, nullptr) != SQLITE_OK)
    complain("the file cannot be opened");
  sqlite3_busy_timeout(database_, kLockPatience);
  sqlite3_extended_result_codes(database_, 0);
  sqlite3_limit(database_, SQLITE_LIMIT_LENGTH, kLongestText);
  sqlite3_db_config(database_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
}

ResultsDatabase::ResultsDatabase(const fs::path& file, Mode mode) : file_(file) {
  if (!fs::exists(file))
    fail(ErrorCode::bad_file, {file.string()},
         "this file does not exist. Name a file that ayumi sweep wrote");
  if (!fs::is_regular_file(fs::symlink_status(file)))
    fail(ErrorCode::bad_file, {file.string()}, "this is not a regular file");
  // The file is also opened in this way for reading, because the last user who could write removes
  // the files that SQLite keeps beside a database. If the file is write-protected, SQLite opens it
  // for reading only.
  open(SQLITE_OPEN_READWRITE);
  try {
    read_head();
  } catch (...) {  // an open database would leave files of SQLite beside it
    sqlite3_close(database_);
    throw;
  }
  if (mode == Mode::read) execute("PRAGMA query_only = ON");
  if (mode == Mode::write) execute("PRAGMA synchronous = NORMAL");
}

ResultsDatabase::ResultsDatabase(const fs::path& file, const SweepHead& head)
    : file_(file), head_(head) {
  require_file_target(file);
  open(SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  make_tables();
}

ResultsDatabase::~ResultsDatabase() { sqlite3_close(database_); }

void ResultsDatabase::close() {
  if (database_ == nullptr) return;
  sqlite3_wal_checkpoint_v2(database_, nullptr, SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr);
  if (sqlite3_close(database_) != SQLITE_OK) complain("the file cannot be closed");
  database_ = nullptr;
}

void ResultsDatabase::make_tables() {
  execute("PRAGMA journal_mode = WAL");
  execute("PRAGMA synchronous = NORMAL");
  std::string sql = "BEGIN IMMEDIATE; PRAGMA application_id = " + std::to_string(kApplication) +
                    "; PRAGMA user_version = " + std::to_string(kDatabaseFormat) + ";" +
                    kHeadTables + case_tables(head_);
  const std::pair<const char*, std::string> about[] = {{"format", "ayumi.sweep/1"},
                                                       {"name", head_.name},
                                                       {"study_file", head_.study_file},
                                                       {"study", head_.study_text},
                                                       {"version", head_.version},
                                                       {"seed", head_.seed},
                                                       {"cases", std::to_string(head_.cases)},
                                                       {"fingerprint", head_.fingerprint()},
                                                       {kSealRow, seal_without_rows().digits()}};
  for (const auto& [key, value] : about)
    sql += "INSERT INTO about VALUES (" + sql_text(key) + ", " + sql_text(value) + ");";
  for (size_t i = 0; i < head_.inputs.size(); ++i)
    sql += "INSERT INTO inputs VALUES (" + std::to_string(i) + ", " +
           sql_text(head_.inputs[i].kind) + ", " + sql_text(head_.inputs[i].name) + ", " +
           sql_text(head_.inputs[i].sha256) + ");";
  for (size_t i = 0; i < head_.axes.size(); ++i)
    sql += "INSERT INTO axes VALUES (" + std::to_string(i) + ", " + sql_text(head_.axes[i]) + ", " +
           sql_text(head_.axis_types[i]) + ");";
  for (size_t i = 0; i < head_.columns.size(); ++i)
    sql += "INSERT INTO figures VALUES (" + std::to_string(i) + ", " +
           sql_text(head_.columns[i].name) + ", " + sql_text(head_.columns[i].type) + ");";
  execute(sql + "COMMIT");
}

// A file from a stranger may have views in place of tables, whose queries never end, or triggers
// that change what is written. So everything that has one of Ayumi's names, or belongs to a table
// with such a name, must be as Ayumi makes it.
void ResultsDatabase::require_made_by(const std::string& sql) const {
  sqlite3* made = nullptr;
  const int opened = sqlite3_open_v2(":memory:", &made, SQLITE_OPEN_READWRITE, nullptr);
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> closed(made, sqlite3_close);
  if (opened != SQLITE_OK ||
      sqlite3_exec(made, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    fail(ErrorCode::bad_file, {file_.string()}, kNoResults);
  const auto schema_of = [&](sqlite3* database) {
    std::vector<std::array<std::string, 4>> list;  // name, its table, kind, SQL
    Statement statement(database,
                        "SELECT lower(name), lower(tbl_name), type, sql FROM sqlite_master");
    if (!statement.good()) complain("the file cannot be read");
    while (statement.step())
      list.push_back({statement.text(0), statement.text(1), statement.text(2), statement.text(3)});
    if (!statement.done()) complain("the file cannot be read");
    return list;
  };
  const auto wanted = schema_of(made), found = schema_of(database_);
  const auto contains = [](const auto& list, const auto& which) {
    return std::any_of(list.begin(), list.end(), which);
  };
  for (const auto& own : wanted)
    if (!contains(found, [&](const auto& each) { return each == own; }))
      fail(ErrorCode::bad_file, {file_.string()},
           "the " + own[2] + " '" + own[0] +
               "' is not as ayumi sweep makes it. Choose another name");
  for (const auto& each : found)
    if (!contains(wanted, [&](const auto& own) { return own == each; }) &&
        contains(wanted, [&](const auto& own) { return own[0] == each[0] || own[0] == each[1]; }))
      fail(ErrorCode::bad_file, {file_.string()},
           "ayumi sweep did not make the " + each[2] + " '" + each[0] + "' of the table '" +
               each[1] + "'. Remove it, or choose another name");
}

void ResultsDatabase::read_head() {
  const auto single = [&](const std::string& sql) -> long {
    Statement statement(database_, sql);
    if (!statement.good() || !statement.step()) complain("the file cannot be read");
    return statement.integer(0);
  };
  if (single("PRAGMA application_id") != kApplication)
    fail(ErrorCode::bad_file, {file_.string()},
         "this file does not contain results of ayumi sweep. Choose another name");
  const long format = single("PRAGMA user_version");
  if (format != kDatabaseFormat)
    fail(ErrorCode::bad_file, {file_.string()},
         "the results have version " + std::to_string(format) +
             " of the format, but this program has " + std::to_string(kDatabaseFormat) +
             ". Use the version of Ayumi that wrote the results, or run the study again with "
             "--force");
  require_made_by(kHeadTables);
  const auto rows = [&](const std::string& sql, const auto& take) {
    Statement statement(database_, sql);
    if (!statement.good()) complain("the file cannot be read");
    while (statement.step()) take(statement);
    if (!statement.done()) complain("the file cannot be read");
  };
  rows("SELECT key, value FROM about", [&](const Statement& row) {
    const std::string key = row.text(0), value = row.text(1);
    if (key == "name") head_.name = value;
    if (key == "study_file") head_.study_file = value;
    if (key == "study") head_.study_text = value;
    if (key == "version") head_.version = value;
    if (key == "seed") head_.seed = value;
    if (key == "cases") {
      head_.cases = std::atol(value.c_str());
      if (std::to_string(head_.cases) != value || head_.cases < 0 ||
          head_.cases > SweepStudy::kMostCases)
        fail(ErrorCode::bad_file, {file_.string()}, kNoResults);
    }
  });
  rows("SELECT kind, name, sha256 FROM inputs ORDER BY place", [&](const Statement& row) {
    head_.inputs.push_back({row.text(0), row.text(1), row.text(2)});
  });
  rows("SELECT name, type FROM axes ORDER BY place", [&](const Statement& row) {
    head_.axes.push_back(row.text(0));
    head_.axis_types.push_back(row.text(1));
  });
  rows("SELECT name, type FROM figures ORDER BY place", [&](const Statement& row) {
    head_.columns.push_back({row.text(0), row.text(1)});
  });
  std::vector<std::string> types = head_.axis_types;
  for (const ResultColumn& column : head_.columns) types.push_back(column.type);
  for (const std::string& type : types)
    if (type != "TEXT" && type != "REAL" && type != "INTEGER")
      fail(ErrorCode::bad_file, {file_.string()}, kNoResults);
  require_made_by(kHeadTables + case_tables(head_));
}

void ResultsDatabase::require_study(const SweepHead& asked, const std::string& remedy) const {
  std::string differs;
  if (head_.version != asked.version)
    differs = "the results are from version " + head_.version + " of Ayumi, not from version " +
              asked.version;
  else if (head_.seed != asked.seed)
    differs = "the results were made with --seed " + head_.seed;
  else
    for (const SweepInput& input : asked.inputs) {
      const bool same =
          std::any_of(head_.inputs.begin(), head_.inputs.end(), [&](const SweepInput& theirs) {
            return theirs.kind == input.kind && theirs.name == input.name &&
                   theirs.sha256 == input.sha256;
          });
      if (!same && differs.empty())
        differs = "the " + input.kind + (input.kind == "study" ? "" : " '" + input.name + "'") +
                  " is different";
    }
  if (differs.empty() && head_.fingerprint() != asked.fingerprint())
    differs = "the inputs are different";
  if (!differs.empty())
    fail(ErrorCode::bad_file, {file_.string()},
         "this file contains the results of another study (" + differs + "). " + remedy);
}

RowSeal ResultsDatabase::seal_without_rows() const { return RowSeal(head_.fingerprint()); }

RowSeal ResultsDatabase::recorded_seal() const {
  Statement statement(database_, "SELECT value FROM main.about WHERE key = " + sql_text(kSealRow));
  if (!statement.good()) complain("the file cannot be read");
  std::optional<RowSeal> seal;
  if (statement.step()) seal = RowSeal::of_digits(statement.text(0));
  if (!seal) fail(ErrorCode::bad_file, {file_.string()}, kNoResults);
  return *seal;
}

void ResultsDatabase::record_seal(const RowSeal& seal) {
  execute("UPDATE main.about SET value = " + sql_text(seal.digits()) +
          " WHERE key = " + sql_text(kSealRow));
}

void ResultsDatabase::change_seal(RowSeal& seal, const std::string& sql, bool add) const {
  Statement statement(database_, sql);
  if (!statement.good()) complain("the file cannot be read");
  while (statement.step()) {
    const std::string row = statement.row_bytes();
    add ? seal.add(row) : seal.remove(row);
  }
  if (!statement.done()) complain("the file cannot be read");
}

void ResultsDatabase::require_unchanged() const {
  // One transaction, because another program may be writing.
  execute("BEGIN");
  struct End {
    sqlite3* database;
    ~End() { sqlite3_exec(database, "COMMIT", nullptr, nullptr, nullptr); }
  } end{database_};
  RowSeal found = seal_without_rows();
  change_seal(found, "SELECT " + list_of(all_columns(head_)) + " FROM cases", true);
  if (!(found == recorded_seal()))
    fail(ErrorCode::bad_file, {file_.string()},
         "the results have changed since ayumi sweep wrote them (their SHA-256 differs from "
         "\"rows_sha256\" of the table 'about'). Leave this file out, or run the study again with "
         "--force");
}

std::vector<std::string> ResultsDatabase::shards() const {
  std::vector<std::string> list;
  for (const auto& row : query("SELECT shard FROM shards ORDER BY shard")) list.push_back(row[0]);
  return list;
}

void ResultsDatabase::add_shards(const std::vector<std::string>& shards) {
  for (const std::string& shard : shards)
    execute("INSERT OR IGNORE INTO shards VALUES (" + sql_text(shard) + ")");
}

std::vector<bool> ResultsDatabase::done() const {
  std::vector<bool> found(static_cast<size_t>(head_.cases));
  mark_done(found);
  return found;
}

void ResultsDatabase::mark_done(std::vector<bool>& cases) const {
  Statement statement(database_, "SELECT \"case\" FROM cases");
  if (!statement.good()) complain("the file cannot be read");
  while (statement.step()) {
    const long number = statement.integer(0);
    if (number >= 0 && number < head_.cases) cases[static_cast<size_t>(number)] = true;
  }
  if (!statement.done()) complain("the file cannot be read");
}

SweepWork ResultsDatabase::work() const {
  SweepWork sum;
  for (const auto& row : query("SELECT key, value FROM about WHERE key LIKE '%seconds'"))
    (row[0] == "seconds" ? sum.seconds : sum.useful) = std::atof(row[1].c_str());
  return sum;
}

void ResultsDatabase::add_work(const SweepWork& more) {
  const SweepWork before = work();
  execute("INSERT OR REPLACE INTO about VALUES ('seconds', " +
          sql_text(text::exact(before.seconds + more.seconds)) + "), ('useful_seconds', " +
          sql_text(text::exact(before.useful + more.useful)) + ")");
}

SweepCounts ResultsDatabase::counts() const {
  const auto row =
      query(
          "SELECT cases, done, errors, stands, falls, unsettled, COALESCE(inconsistent, 0) FROM "
          "summary")
          .at(0);
  const auto count = [&](size_t i) { return std::atol(row[i].c_str()); };
  return {count(0), count(1), count(2), count(3), count(4), count(5), count(6)};
}

long ResultsDatabase::forget_errors(const std::vector<bool>& cases) {
  std::vector<long> numbers;
  for (const auto& row : query("SELECT \"case\" FROM cases WHERE error IS NOT NULL")) {
    const long number = std::atol(row[0].c_str());
    if (number >= 0 && number < head_.cases && cases[static_cast<size_t>(number)])
      numbers.push_back(number);
  }
  execute("BEGIN IMMEDIATE");
  RowSeal seal = recorded_seal();
  const std::string row_of =
      "SELECT " + list_of(all_columns(head_)) + " FROM cases WHERE \"case\" = ";
  Statement remove(database_, "DELETE FROM cases WHERE \"case\" = ?");
  if (!remove.good()) complain("the results cannot be written");
  for (const long number : numbers) {
    change_seal(seal, row_of + std::to_string(number), false);
    remove.bind(1, number);
    remove.step();
    if (!remove.done()) complain("the results cannot be written");
    remove.reset();
  }
  record_seal(seal);
  execute("COMMIT");
  return static_cast<long>(numbers.size());
}

void ResultsDatabase::add(const std::vector<CaseRow>& rows) {
  if (rows.empty()) return;
  const size_t count = 2 + head_.axes.size() + head_.columns.size();
  std::string places = "?";
  for (size_t i = 1; i < count; ++i) places += ",?";
  execute("BEGIN IMMEDIATE");
  RowSeal seal = recorded_seal();
  const std::string row_of =
      "SELECT " + list_of(all_columns(head_)) + " FROM cases WHERE \"case\" = ?";
  Statement insert(database_, "INSERT INTO cases VALUES (" + places + ")");
  Statement inserted(database_, row_of);
  if (!insert.good() || !inserted.good()) complain("the results cannot be written");
  for (const CaseRow& row : rows) {
    int place = 1;
    insert.bind(place++, row.number);
    for (const Cell& cell : row.axes) insert.bind(place++, cell);
    insert.bind(place++, row.error.empty() ? Cell() : Cell(row.error));
    for (const Cell& cell : row.figures) insert.bind(place++, cell);
    insert.step();
    if (!insert.done()) complain("the results cannot be written");
    insert.reset();
    // SQLite may have converted a value to the type of its column, so the row is read again.
    inserted.bind(1, row.number);
    if (!inserted.step()) complain("the results cannot be written");
    seal.add(inserted.row_bytes());
    inserted.reset();
  }
  record_seal(seal);
  execute("COMMIT");
}

long ResultsDatabase::merge(const fs::path& other) {
  {
    const ResultsDatabase theirs(other, Mode::read);
    if (theirs.head().fingerprint() != head_.fingerprint()) {
      theirs.require_study(head_, "Leave this file out");
      fail(ErrorCode::bad_file, {other.string()},
           "this file contains the results of another study. Leave this file out");
    }
  }
  execute("ATTACH DATABASE " + sql_text(other.string()) + " AS theirs");
  struct Detach {
    sqlite3* database;
    ~Detach() {
      sqlite3_exec(database, "ROLLBACK", nullptr, nullptr, nullptr);
      sqlite3_exec(database, "DETACH DATABASE theirs", nullptr, nullptr, nullptr);
    }
  } detach{database_};
  execute("BEGIN IMMEDIATE");
  const std::vector<std::string> names = all_columns(head_);
  std::vector<std::string> unequal;
  for (const std::string& name : names)
    unequal.push_back("a." + sql_name(name) + " IS NOT b." + sql_name(name));
  Statement different(database_,
                      // CROSS JOIN makes SQLite go through the rows of the other file, of which
                      // there may be far fewer.
                      "SELECT a.\"case\" FROM theirs.cases b CROSS JOIN main.cases a ON "
                      "a.\"case\" = b.\"case\" WHERE a.error IS NULL AND b.error IS "
                      "NULL AND (" +
                          text::join(unequal, " OR ") + ") ORDER BY 1 LIMIT 1");
  if (!different.good()) complain("the files cannot be compared");
  if (different.step())
    fail(ErrorCode::bad_file, {other.string()},
         "the result of case " + std::to_string(different.integer(0)) +
             " differs from the result in " + file_.string() + ". Nothing of " + other.string() +
             " was merged");
  if (!different.done()) complain("the files cannot be compared");
  different.reset();
  const std::string replaced_rows =
      " FROM main.cases WHERE error IS NOT NULL AND \"case\" IN (SELECT \"case\" FROM theirs.cases "
      "WHERE error IS NULL)";
  RowSeal seal = recorded_seal();
  change_seal(seal, "SELECT " + list_of(names) + replaced_rows, false);
  execute("DELETE" + replaced_rows);
  const long replaced = sqlite3_changes(database_);
  change_seal(seal,
              "SELECT " + list_of(names, "b.") +
                  " FROM theirs.cases b WHERE NOT EXISTS (SELECT 1 FROM main.cases a WHERE "
                  "a.\"case\" = b.\"case\")",
              true);
  execute("INSERT OR IGNORE INTO main.cases (" + list_of(names) + ") SELECT " + list_of(names) +
          " FROM theirs.cases");
  const long added = sqlite3_changes(database_) - replaced;
  execute("INSERT OR IGNORE INTO main.shards SELECT shard FROM theirs.shards");
  record_seal(seal);
  execute("COMMIT");
  return added;
}

void ResultsDatabase::csv(const std::function<void(const std::string& line)>& take) const {
  const std::vector<std::string> names = all_columns(head_);
  std::string line;
  for (size_t i = 0; i < names.size(); ++i) line += (i ? "," : "") + csv_cell(names[i]);
  take(line + "\n");
  Statement statement(database_, "SELECT " + list_of(names) + " FROM cases ORDER BY \"case\"");
  if (!statement.good()) complain("the file cannot be read");
  while (statement.step()) {
    line.clear();
    for (int i = 0; i < statement.columns(); ++i)
      line += (i ? "," : "") + csv_cell(statement.cell(i));
    take(line + "\n");
  }
  if (!statement.done()) complain("the file cannot be read");
}

void ResultsDatabase::write_csv(const fs::path& file) const {
  std::ofstream stream(file, std::ios::binary);
  const auto require_written = [&] {
    if (!stream)
      fail(ErrorCode::bad_file, {file.string()},
           std::string("the table cannot be written: ") + std::strerror(errno) +
               ". Make room and try again");
  };
  csv([&](const std::string& line) {
    stream << line;
    require_written();
  });
  stream.close();
  require_written();
}

std::vector<std::vector<std::string>> ResultsDatabase::query(const std::string& sql) const {
  Statement statement(database_, sql);
  if (!statement.good()) fail(ErrorCode::usage, said_by(database_));
  std::vector<std::vector<std::string>> rows;
  while (statement.step()) {
    std::vector<std::string> row;
    for (int i = 0; i < statement.columns(); ++i) row.push_back(statement.cell(i));
    rows.push_back(std::move(row));
  }
  if (!statement.done()) complain("the file cannot be read");
  return rows;
}

}  // namespace ayumi::app
