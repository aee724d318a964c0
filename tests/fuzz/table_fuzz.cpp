// Reference tables, tables of patterns and recordings.

#include "ayumi/io/table/recording.hpp"
#include "ayumi/io/table/table.hpp"
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const fuzz::InputFolder folder({{"", bytes}}, "table.csv");
  const auto path = folder.path("table.csv");
  ReferenceTrajectory reference;
  if (fuzz::accepts([&] { reference = read_reference(path); })) {
    const std::string text = reference_csv(reference);
    const fuzz::InputFolder written({{"", text}}, "written.csv");
    std::string again;
    fuzz::expect(
        fuzz::accepts([&] { again = reference_csv(read_reference(written.path("written.csv"))); }),
        "what reference_csv writes is read");
    fuzz::expect(again == text, "a table that was written and read is the same");
  }
  DenseTable dense;
  if (fuzz::accepts([&] { dense = read_dense_table(path); })) {
    const fuzz::InputFolder written({{"", dense_table_csv(dense)}}, "written.csv");
    fuzz::expect(fuzz::accepts([&] { read_dense_table(written.path("written.csv")); }),
                 "what dense_table_csv writes is read");
  }
  fuzz::accepts([&] { read_table_caution(path); });
  fuzz::accepts([&] { read_angles(bytes, path.string(), fuzz::hoap1()); });
  fuzz::accepts([&] {
    if (holds_sensors(bytes, path.string(), fuzz::hoap1()))
      read_sensors_table(bytes, path.string(), fuzz::hoap1());
  });
  return 0;
}
