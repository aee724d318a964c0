#include "sweep/expectations.hpp"

#include <cctype>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/run/sha256_stream.hpp"
#include "ayumi/math/statistics.hpp"
#include "ayumi/plot/drawing.hpp"

namespace ayumi::app {

using Json = nlohmann::ordered_json;

namespace {

/// Number of cases that are listed as the worst. Definition.
constexpr int kListed = 10;
std::vector<std::string> summary_names(const ResultsDatabase& results) {
  std::vector<std::string> names;
  for (const auto& row : results.query("SELECT name FROM pragma_table_info('summary')"))
    names.push_back(row[0]);
  return names;
}

std::vector<std::string> words_in(const std::string& text) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
      word += c;
    } else if (!word.empty()) {
      words.push_back(word);
      word.clear();
    }
  }
  return words;
}

Json number_or_null(const std::string& cell) {
  return cell.empty() ? Json(nullptr) : Json(std::atof(cell.c_str()));
}

/// The rows of a query as JSON objects.
Json rows_json(const ResultsDatabase& results, const std::vector<std::string>& names,
               const std::vector<bool>& numbers, const std::string& sql) {
  Json list = Json::array();
  for (const auto& row : results.query(sql)) {
    Json object = Json::object();
    for (size_t i = 0; i < names.size(); ++i) {
      if (row[i].empty()) continue;
      object[names[i]] = numbers[i] ? number_or_null(row[i]) : Json(row[i]);
    }
    list.push_back(object);
  }
  return list;
}

Json cases_json(const ResultsDatabase& results, const std::string& view, int count) {
  const SweepHead& head = results.head();
  std::vector<std::string> names = {"case"}, columns = {sql_name("case")};
  std::vector<bool> numbers = {true};
  for (size_t i = 0; i < head.axes.size(); ++i) {
    names.push_back(head.axes[i]);
    columns.push_back(sql_name(head.axes[i]));
    numbers.push_back(head.axis_types[i] != "TEXT");
  }
  names.emplace_back("error");
  columns.emplace_back("error");
  numbers.push_back(false);
  for (const ResultColumn& column : head.columns) {
    names.push_back(column.name);
    columns.push_back(sql_name(column.name));
    numbers.push_back(column.type != "TEXT");
  }
  Json list = rows_json(
      results, names, numbers,
      "SELECT " + text::join(columns, ", ") + " FROM " + view + " LIMIT " + std::to_string(count));
  for (Json& row : list) row["case"] = std::lround(row["case"].get<double>());
  return list;
}

/// Number, settings and outcome of a case.
std::string case_in_words(const SweepHead& head, const Json& row) {
  std::string words = "case " + std::to_string(row.at("case").get<long>());
  for (const std::string& axis : head.axes)
    if (row.contains(axis)) {
      const Json& value = row.at(axis);
      words += ", " + axis + " " +
               (value.is_string() ? value.get<std::string>() : text::brief(value.get<double>(), 6));
    }
  const bool broken = row.contains("error");
  if (broken || row.contains("outcome"))
    words += ": " + row.at(broken ? "error" : "outcome").get<std::string>();
  if (!broken && row.contains("fell_at_s"))
    words += " at " + text::fixed(row.at("fell_at_s").get<double>(), 2) + " s";
  return words;
}

}  // namespace

std::vector<Expectation> judge_expectations(const ResultsDatabase& results,
                                            const std::vector<std::string>& texts) {
  const std::vector<std::string> names = summary_names(results);
  std::vector<std::string> all = texts;
  bool errors = false;
  for (const std::string& text : texts)
    for (const std::string& word : words_in(text)) errors = errors || word == "errors";
  if (!errors) all.emplace_back("errors == 0");
  std::vector<Expectation> judged;
  for (const std::string& text : all) {
    Expectation expectation;
    expectation.text = text;
    std::vector<std::vector<std::string>> value;
    try {
      value = results.query("SELECT (" + text + ") FROM summary");
    } catch (const Error& error) {
      std::string hint;
      const std::string why = error.what();
      const size_t column = why.rfind(": ");
      if (why.starts_with("no such column"))
        hint =
            text::suggestion(why.substr(column + 2), names) +
            ". The names are the columns of the view \"summary\" (docs/formats.md, Sweep results)";
      fail(ErrorCode::usage, "--expect '" + text + "': " + why + hint);
    }
    expectation.met = !value.empty() && !value[0][0].empty() && std::atof(value[0][0].c_str()) != 0;
    std::vector<std::string> found;
    for (const std::string& word : words_in(text))
      if (std::find(names.begin(), names.end(), word) != names.end()) {
        const std::string cell = results.query("SELECT " + word + " FROM summary").at(0).at(0);
        found.push_back(word + " = " + (cell.empty() ? "unknown" : cell));
      }
    expectation.found = text::join(found, ", ");
    judged.push_back(expectation);
  }
  return judged;
}

Json worst_cases(const ResultsDatabase& results, int count) {
  return cases_json(results, "worst", count);
}

Json results_json(const ResultsDatabase& results, const std::vector<Expectation>& expectations) {
  const SweepHead& head = results.head();
  const SweepCounts counts = results.counts();
  const long runs = counts.stands + counts.failures();
  Json inputs = Json::array();
  for (const SweepInput& input : head.inputs)
    inputs.push_back({{"kind", input.kind}, {"name", input.name}, {"sha256", input.sha256}});
  Json json = {{"study", head.name},
               {"version", head.version},
               {"seed", head.seed},
               {"inputs", inputs},
               {"cases", counts.cases},
               {"done", counts.done},
               {"errors", counts.errors},
               {"stands", counts.stands},
               {"falls", counts.falls},
               {"unsettled", counts.unsettled},
               {"inconsistent", counts.inconsistent}};
  if (runs > 0) {
    const RateInterval rate = clopper_pearson(counts.failures(), runs, kRateConfidence);
    json["failure_rate"] = {{"rate", double(counts.failures()) / double(runs)},
                            {"low", rate.low},
                            {"high", rate.high},
                            {"confidence", kRateConfidence}};
  }
  Json judged = Json::array();
  for (const Expectation& e : expectations)
    judged.push_back({{"expect", e.text}, {"met", e.met}, {"found", e.found}});
  json["expectations"] = judged;
  if (!head.axes.empty()) {
    Json rates = Json::array();
    for (const auto& row :
         results.query("SELECT axis, value, runs, falls, unsettled, errors FROM rates WHERE axis "
                       "NOT IN ('seed', 'draw') ORDER BY place, value")) {
      const long n = std::lround(std::atof(row[2].c_str())),
                 k = std::lround(std::atof(row[3].c_str()) + std::atof(row[4].c_str()));
      const RateInterval rate = clopper_pearson(k, n, kRateConfidence);
      rates.push_back({{"setting", row[0]},
                       {"value", row[1]},
                       {"runs", n},
                       {"failures", k},
                       {"errors", std::lround(std::atof(row[5].c_str()))},
                       {"low", rate.low},
                       {"high", rate.high}});
    }
    json["rates"] = rates;
  }
  json["worst_cases"] = worst_cases(results, kListed);
  Sha256Stream csv;
  results.csv([&](const std::string& line) { csv.add(line); });
  json["csv_sha256"] = csv.digits();
  return json;
}

std::string junit_text(const ResultsDatabase& results,
                       const std::vector<Expectation>& expectations) {
  const auto unmet = std::count_if(expectations.begin(), expectations.end(),
                                   [](const Expectation& e) { return !e.met; });
  const std::string counts = " tests=\"" + std::to_string(expectations.size()) + "\" failures=\"" +
                             std::to_string(unmet) + "\" errors=\"0\"";
  const std::string name = escaped(results.head().name);
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites" + counts +
                     ">\n<testsuite name=\"" + name + "\"" + counts + ">\n";
  for (const Expectation& e : expectations) {
    text += "<testcase classname=\"" + name + "\" name=\"" + escaped(e.text) + "\"";
    if (e.met) {
      text += "/>\n";
      continue;
    }
    text += "><failure message=\"" + escaped(e.found) + "\">";
    for (const Json& row : cases_json(results, "failed", kListed))
      text += escaped(case_in_words(results.head(), row)) + "\n";
    text += "</failure></testcase>\n";
  }
  return text + "</testsuite>\n</testsuites>\n";
}

}  // namespace ayumi::app
