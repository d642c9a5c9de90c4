// Judges hulls of natural models and of cases: for each family and variant, and each case, a line
// of how many are closed, within the resolution and verified, of wrong claims and counts, and
// times.
//   judge [SEEDS] [NAME | -NAME ...]   5 seeds of all; what has the names, without those after -
// A name is a run of whole parts of "families/GROUP/FAMILY/VARIANT" or "cases/GROUP/CASE", as
// "turned", "gear/float32" or "cases". Cases are sought in the folder "cases" beside that which
// TAUT_MODELS names.
// Exits 1 if anything claimed is wrong or miscounted, 2 if nothing has the names, 77 if there was
// nothing but cases to judge and their folder is not there.

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cases.h"
#include "judge.h"

namespace {

using namespace taut_test;  // NOLINT: the judge
using taut::HullOptions;

constexpr int exit_wrong = 1, exit_nothing = 2, exit_skipped = 77;

class Names {
 public:
  explicit Names(const std::vector<std::string>& arguments) {
    for (const std::string& a : arguments) {
      if (a.starts_with('-')) {
        without_.push_back(a.substr(1));
      } else {
        with_.push_back(a);
      }
    }
  }
  bool ask(const std::string& name) const {
    const auto has = [&](const std::string& part) {
      return ("/" + name + "/").find("/" + part + "/") != std::string::npos;
    };
    return (with_.empty() || std::any_of(with_.begin(), with_.end(), has)) &&
           std::none_of(without_.begin(), without_.end(), has);
  }

 private:
  std::vector<std::string> with_, without_;
};

/// Prints the line of verdicts of one name. Whether nothing is wrong.
bool print(const std::string& name, const std::vector<Verdict>& verdicts) {
  int closed = 0, within = 0, verified = 0, wrong = 0, miscounted = 0, unresolved = 0;
  double seconds = 0, bound = 0;
  std::string reason, counts, missed;
  for (const Verdict& v : verdicts) {
    closed += v.closed ? 1 : 0;
    within += v.within ? 1 : 0;
    verified += v.verified ? 1 : 0;
    wrong += v.wrong.empty() ? 0 : 1;
    miscounted += v.miscounted.empty() ? 0 : 1;
    unresolved += v.unresolved;
    seconds = std::max(seconds, v.seconds);
    bound = std::max(bound, v.bound);
    if (reason.empty() && !v.wrong.empty()) reason = "  " + v.wrong;
    if (missed.empty()) missed = v.missed;
    if (counts.empty() && !v.miscounted.empty()) counts = ": " + v.miscounted;
  }
  const Verdict& first = verdicts.front();
  if (!missed.empty()) reason += "  " + missed;
  if (miscounted > 0) reason += "  counts " + std::to_string(miscounted) + counts;
  std::printf(
      "%-44s closed %d/%zu within %d verified %d wrong %d  p/s/f/c %-12s measured %-2s unresolved "
      "%-5d "
      "bound %.1e  %.2f s%s\n",
      name.c_str(), closed, verdicts.size(), within, verified, wrong, text(first.found).c_str(),
      first.measured.empty() ? "-" : first.measured.c_str(), unresolved, bound, seconds,
      reason.c_str());
  std::fflush(stdout);
  return wrong == 0 && miscounted == 0;
}

Verdict tried(const std::function<Verdict()>& judge) {
  try {
    return judge();
  } catch (const std::exception& error) {
    Verdict v;
    v.wrong = error.what();
    return v;
  }
}

bool judge(const std::string& name, const Family& family, Variant variant, int seeds,
           const HullOptions& options) {
  std::vector<Verdict> verdicts;
  for (int seed = 1; seed <= seeds; ++seed) {
    taut_test::Random random(static_cast<unsigned long>(seed));
    const Natural natural = family.make(random);
    verdicts.push_back(tried([&] { return judged(natural, variant, random, options); }));
  }
  return print(name, verdicts);
}

bool judge(const std::string& name, const std::filesystem::path& folder, const Case& one,
           const HullOptions& options) {
  taut_test::Random random(1);
  const Verdict verdict = tried([&] { return judged(read_case(folder, one), random, options); });
  return print(name, {verdict});
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  int seeds = 5;
  if (!arguments.empty() && std::isdigit(static_cast<unsigned char>(arguments[0][0])) != 0) {
    seeds = std::max(1, std::atoi(arguments[0].c_str()));
    arguments.erase(arguments.begin());
  }
  HullOptions options;
  const Names names(arguments);
  int asked = 0, skipped = 0;
  bool right = true;
  for (const FamilyGroup& group : family_groups()) {
    for (const Family& family : group.families) {
      for (const Variant variant : all_variants) {
        const std::string name = group.name + "/" + family.name + "/" + name_of(variant);
        if (!names.ask("families/" + name)) continue;
        ++asked;
        right &= judge(name, family, variant, seeds, options);
      }
    }
  }
  const auto folder = folder_of_cases();
  for (const CaseGroup& group : case_groups()) {
    for (const Case& one : group.cases) {
      const std::string name = "cases/" + one.name();
      if (!names.ask(name)) continue;
      ++asked;
      if (folder) {
        right &= judge(name, *folder, one, options);
      } else {
        ++skipped;
      }
    }
  }
  if (skipped > 0) {
    std::printf("%d cases skipped: TAUT_MODELS names no folder beside one of cases\n", skipped);
  }
  if (asked == 0) return exit_nothing;
  if (!right) return exit_wrong;
  return skipped == asked ? exit_skipped : 0;
}
