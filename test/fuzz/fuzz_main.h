// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_TEST_FUZZ_MAIN_H
#define SPECTRAL_TEST_FUZZ_MAIN_H

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

// What runs a fuzz target: libFuzzer if SPECTRAL_LIBFUZZER is defined, otherwise a main() with RUNS
// SEED or FILE...
namespace spectral_test {

using Byte_string = std::vector<std::uint8_t>;

// What went wrong with these bytes, empty if nothing did.
std::string checked(const std::uint8_t* data, std::size_t size);

// One input of a run with numbers drawn from a seed.
Byte_string random_input(std::mt19937& random);

// The input that a file holds.
Byte_string input_of_file(const std::string& path, const Byte_string& contents);

} // namespace spectral_test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, const std::size_t size)
{
  const std::string fault = spectral_test::checked(data, size);
  if(fault.empty())
    return 0;
  std::fprintf(stderr, "%s\n", fault.c_str());
  std::abort();
}

#ifndef SPECTRAL_LIBFUZZER

int main(int argc, char* argv[])
{
  using namespace spectral_test;
  int failures = 0;
  const auto run = [&](const Byte_string& bytes, const std::string& name) {
    const std::string fault = checked(bytes.data(), bytes.size());
    if(!fault.empty()) {
      ++failures;
      std::printf("%s: %s\n", name.c_str(), fault.c_str());
    }
  };
  char* end = nullptr;
  const unsigned long runs = argc == 3 ? std::strtoul(argv[1], &end, 10) : 0;
  if(runs > 0 && *end == '\0') {
    const unsigned long seed = std::strtoul(argv[2], nullptr, 10);
    for(unsigned long i = 0; i < runs; ++i) {
      std::mt19937 random(static_cast<std::uint32_t>(seed + i));
      run(random_input(random), "1 " + std::to_string(seed + i));
    }
    std::printf("%lu runs, %d failures\n", runs, failures);
  } else {
    for(int i = 1; i < argc; ++i) {
      std::ifstream stream(argv[i], std::ios::binary);
      const std::vector<char> text{std::istreambuf_iterator<char>(stream),
                                   std::istreambuf_iterator<char>()};
      run(input_of_file(argv[i], Byte_string(text.begin(), text.end())), argv[i]);
    }
    std::printf("%d files, %d failures\n", argc - 1, failures);
  }
  return failures == 0 ? 0 : 1;
}

#endif

#endif // SPECTRAL_TEST_FUZZ_MAIN_H
