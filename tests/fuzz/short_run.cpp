// The engine without coverage, for any compiler: `TARGET FOLDER COUNT` runs every seed of the
// folder and then COUNT mutants of them, always the same ones. An input that takes too long, and
// one at which the process ends, stay behind in the file `last_input` of the working folder.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "mutation.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace {

using Clock = std::chrono::steady_clock;

// Longest time of an input [s]. Chosen: an input may take 2 s; other programs share the processor.
constexpr double kMost = 20;
// Largest size of an input [bytes]. Chosen: the largest seed has half of it.
constexpr size_t kLargest = 1 << 20;

void run(const std::string& input) {
  std::ofstream("last_input", std::ios::binary) << input;
  const auto begin = Clock::now();
  LLVMFuzzerTestOneInput(reinterpret_cast<const uint8_t*>(input.data()), input.size());
  const double took = std::chrono::duration<double>(Clock::now() - begin).count();
  if (took > kMost) {
    std::fprintf(stderr, "fuzz: an input took %.1f s; it is in the file last_input\n", took);
    std::abort();
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s FOLDER COUNT\n", argv[0]);
    return 2;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> inputs;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  if (inputs.empty()) {
    std::fprintf(stderr, "%s: no seeds\n", argv[1]);
    return 2;
  }
  for (const std::string& input : inputs) run(input);
  const long count = std::atol(argv[2]);
  ayumi::fuzz::Random random(1);
  const size_t seeds = inputs.size();
  for (long i = 0; i < count; ++i) {
    // Every fourth time a mutant is mutated again.
    std::string& from = inputs[random() % (random() % 4 ? seeds : inputs.size())];
    const std::string mutant = ayumi::fuzz::mutate_input(from, random);
    if (mutant.size() > kLargest) continue;
    run(mutant);
    if (inputs.size() < seeds + 64)
      inputs.push_back(mutant);
    else
      inputs[seeds + random() % 64] = mutant;
  }
  std::filesystem::remove("last_input");
  std::printf("%s: %zu seeds and %ld mutants, no defect\n", argv[0], seeds, count);
}
