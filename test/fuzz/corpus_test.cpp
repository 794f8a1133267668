// Runs the fuzzer's start corpus, all its findings and a fixed number of mutations of both, without the fuzzer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace hammer_loads {
namespace {

using Input = std::vector<std::uint8_t>;

/// Returns the files in HAMMER_LOADS_FUZZ_INPUTS by name; all config files as one input are whole settings.
std::vector<Input> inputs() {
  std::vector<std::filesystem::path> files;
  std::istringstream directories(HAMMER_LOADS_FUZZ_INPUTS);
  for (std::string directory; std::getline(directories, directory, ':');) {
    if (!std::filesystem::exists(directory)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(directory)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<Input> all;
  for (const auto& path : files) {
    std::ifstream file(path, std::ios::binary);
    all.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return all;
}

void run(const Input& input) { LLVMFuzzerTestOneInput(input.data(), input.size()); }

TEST(Corpus, EveryKnownInputPasses) {
  const std::vector<Input> known = inputs();
  ASSERT_FALSE(known.empty());
  for (const Input& input : known) run(input);
}

Input mutation(const std::vector<Input>& known, std::mt19937& random) {
  const auto below = [&](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  Input input = known[below(known.size())];
  for (std::size_t changes = 1 + below(8); changes > 0 && !input.empty(); --changes) {
    const std::size_t at = below(input.size()), length = std::min(1 + below(16), input.size() - at);
    const auto place = input.begin() + static_cast<std::ptrdiff_t>(at);
    const auto end = place + static_cast<std::ptrdiff_t>(length);
    switch (below(5)) {
      case 0:
        *place = static_cast<std::uint8_t>(below(256));
        break;
      case 1:
        *place = static_cast<std::uint8_t>(*place ^ (1U << below(8)));
        break;
      case 2:
        input.erase(place, end);
        break;
      case 3:
        std::generate(place, end, [&] { return static_cast<std::uint8_t>(below(256)); });
        break;
      default: {
        const Input piece(place, end);
        input.insert(input.begin() + static_cast<std::ptrdiff_t>(below(input.size())), piece.begin(), piece.end());
      }
    }
  }
  return input;
}

TEST(Corpus, MutationsPass) {
  const std::vector<Input> known = inputs();
  std::mt19937 random(1);
  for (int i = 0; i < HAMMER_LOADS_FUZZ_MUTATIONS; ++i) run(mutation(known, random));
}

}  // namespace
}  // namespace hammer_loads
