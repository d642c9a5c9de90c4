// Judges hulls of natural models: for each family and variant a line of how many are closed and
// verified, of wrong claims, and times.
//   judge [SEEDS [FAMILY ...]]    5 seeds of all families; exits 1 if anything claimed is wrong

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "judge.h"

namespace {

using namespace taut_test;  // NOLINT: the judge

/// Prints the line. How many claims are wrong.
int judge(const Family& family, Variant variant, int seeds) {
  int closed = 0, verified = 0, wrong = 0, unresolved = 0;
  double seconds = 0, bound = 0;
  std::string counts, reason;
  for (int seed = 1; seed <= seeds; ++seed) {
    taut_test::Random random(static_cast<unsigned long>(seed));
    const Natural natural = family.make(random);
    Verdict v;
    try {
      v = judged(natural, variant, random);
    } catch (const std::exception& error) {
      v.wrong = error.what();
    }
    closed += v.closed ? 1 : 0;
    verified += v.verified ? 1 : 0;
    unresolved += v.unresolved;
    wrong += v.wrong.empty() ? 0 : 1;
    if (reason.empty() && !v.wrong.empty()) reason = "  " + v.wrong;
    seconds = std::max(seconds, v.seconds);
    bound = std::max(bound, v.bound);
    if (seed == 1) {
      counts = std::to_string(v.patches) + "/" + std::to_string(v.scrolls) + "/" +
               std::to_string(v.facets) + "/" + std::to_string(v.curves);
    }
  }
  std::printf(
      "%-27s %-8s closed %d/%d verified %d wrong %d  p/s/f/c %-12s unresolved %-5d "
      "bound %.1e  %.2f s%s\n",
      family.name.c_str(), name_of(variant), closed, seeds, verified, wrong, counts.c_str(),
      unresolved, bound, seconds, reason.c_str());
  std::fflush(stdout);
  return wrong;
}

}  // namespace

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
  const std::vector<std::string> names(argv + std::min(argc, 2), argv + argc);
  int wrong = 0;
  for (const Family& family : families()) {
    const bool asked = names.empty() || std::count(names.begin(), names.end(), family.name) > 0;
    for (const Variant variant : all_variants) {
      if (asked) wrong += judge(family, variant, seeds);
    }
  }
  return wrong > 0 ? 1 : 0;
}
