// One reader under libFuzzer; which one, the build says: TAUT_FUZZ_FORMAT, TAUT_FUZZ_KIND and, of
// cages, TAUT_FUZZ_SCHEME.

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "read_one.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const taut_test::Reader reader = {taut_test::Reader::Kind::TAUT_FUZZ_KIND,
                                           TAUT_FUZZ_FORMAT, TAUT_FUZZ_SCHEME};
  constexpr std::chrono::milliseconds limit(500);  // there are many inputs to try
  // Beside the seeds, where the layers of projects are.
  static const std::string name = TAUT_FUZZ_CORPUS "/" + reader.corpus() + "/input";
  try {
    taut_test::read_one(reader, {reinterpret_cast<const char*>(bytes), size}, name, limit);
  } catch (const taut_test::Finding& finding) {
    std::fprintf(stderr, "finding: %s\n", finding.what());
    std::abort();
  }
  return 0;
}
