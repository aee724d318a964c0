#pragma once
// The results of a sweep in one SQLite file: a row for each case, the hash of every input, and
// views for the usual questions. docs/formats.md, "Sweep results", is the specification. Committed
// rows are kept, however the program ends.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sweep/case_runner.hpp"
#include "sweep/row_seal.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace ayumi::app {

/// Identification of the study to which the results belong. Two databases with the same fingerprint
/// have the same rows for the same cases.
struct SweepHead {
  std::string name;        ///< name of the study
  std::string study_file;  ///< file of the study as it was given
  std::string study_text;
  std::string version;  ///< version of Ayumi
  std::string seed;     ///< seed of the cases that set none
  long cases = 0;
  std::vector<std::string> axes;
  std::vector<std::string> axis_types = {};  ///< "TEXT" or "REAL"
  std::vector<ResultColumn> columns;
  std::vector<SweepInput> inputs;
  std::string fingerprint() const;
};
SweepHead head_of(const CaseRunner& runner, std::uint64_t seed);

/// Counts of a database.
struct SweepCounts {
  long cases = 0;  ///< number of cases of the study
  long done = 0, errors = 0, stands = 0, falls = 0, unsettled = 0, inconsistent = 0;
  long failures() const { return falls + unsettled; }
};

/// Processor time [s] that was used for rows.
struct SweepWork {
  /// Processor time of all threads, including reading of inputs and writing of rows.
  double seconds = 0;
  double useful = 0;  ///< the part of it for simulating, checking and repairing
};

class ResultsDatabase {
 public:
  enum class Mode { read, write };
  /// Opens an existing database. Throws Error(bad_file) "file: what, what to do" if it is not one
  /// of Ayumi's, has another version of the format, or cannot be opened.
  ResultsDatabase(const std::filesystem::path& file, Mode mode);
  /// Makes a new database.
  ResultsDatabase(const std::filesystem::path& file, const SweepHead& head);
  ~ResultsDatabase();
  ResultsDatabase(const ResultsDatabase&) = delete;
  ResultsDatabase& operator=(const ResultsDatabase&) = delete;

  const std::filesystem::path& file() const { return file_; }
  const SweepHead& head() const { return head_; }
  /// Throws Error(bad_file), which names the difference and what to do, if the results do not
  /// belong to this study.
  void require_study(
      const SweepHead& head,
      const std::string& remedy = "Choose another name, or give --force to begin again") const;

  /// Throws Error(bad_file) if a row was changed, added or removed by anything but this class.
  void require_unchanged() const;

  /// The shards whose results are in this file, such as "1/4"; empty if the whole study was run.
  std::vector<std::string> shards() const;
  void add_shards(const std::vector<std::string>& shards);
  /// Processor time that was used for the rows, over all runs that recorded it.
  SweepWork work() const;
  void add_work(const SweepWork& more);

  /// For each case, whether it has a row.
  std::vector<bool> done() const;
  /// Marks the cases that have a row.
  void mark_done(std::vector<bool>& cases) const;
  SweepCounts counts() const;
  /// Removes the rows of those of the given cases that could not be run. Returns the number of
  /// removed rows.
  long forget_errors(const std::vector<bool>& cases);

  /// Adds rows; they are committed when this returns.
  void add(const std::vector<CaseRow>& rows);
  /// Adds the rows of another file of the same study. A case that both have must be the same to the
  /// last bit; a result replaces an error. Returns the number of added rows. Throws
  /// Error(bad_file), and then this file is unchanged. Does not test whether the rows of the other
  /// file have changed: require_unchanged() does.
  long merge(const std::filesystem::path& other);

  /// All rows by number, as a table with one head row. `take` receives one line after the other.
  void csv(const std::function<void(const std::string& line)>& take) const;
  void write_csv(const std::filesystem::path& file) const;
  /// The rows of a query, with every cell as in the CSV. Throws Error(usage) with SQLite's words if
  /// the query is wrong.
  std::vector<std::vector<std::string>> query(const std::string& sql) const;

  /// Writes everything into the file itself and closes it.
  void close();

 private:
  void open(int flags);
  void execute(const std::string& sql) const;
  [[noreturn]] void complain(const std::string& doing) const;
  void read_head();
  /// The seal that the file records, and what it must be without any row.
  RowSeal recorded_seal() const;
  RowSeal seal_without_rows() const;
  void record_seal(const RowSeal& seal);
  /// Adds the rows of a query over all columns to a seal, or takes them away.
  void change_seal(RowSeal& seal, const std::string& sql, bool add) const;
  void make_tables();
  /// Throws Error(bad_file), naming it, where a table or view differs from that of this SQL.
  void require_made_by(const std::string& sql) const;

  std::filesystem::path file_;
  SweepHead head_;
  sqlite3* database_ = nullptr;
};

/// A name in double quotes for SQL.
std::string sql_name(const std::string& name);
/// A text in single quotes for SQL.
std::string sql_text(const std::string& text);

}  // namespace ayumi::app
