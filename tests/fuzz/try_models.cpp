// Models at random, and all small cages, from reading to a coarse hull (read_one.h):
//   try_models cages FIRST COUNT          random_cage() of COUNT seeds from FIRST on
//   try_models surfaces FIRST COUNT       random_surfaces()
//   try_models gluings FIRST COUNT        each_gluing() of up to three triangles and quads, and of
//                                         four triangles: by their numbers in that order
// Each stops after a while, a few of them later than most, so that what comes late is tried too. A
// model is a finding if it breaks what read_one() asks, if the process that has it dies, by a
// signal or a sanitizer, or if it takes over 10 s (ten times that under sanitizers). Its file is
// written to the folder at hand, finding_KIND_SEED.obj or .taut.json, and the run goes on. Exits 0
// if there is none. Runs may go beside each other, each with its own part of the seeds.

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "random_models.h"

namespace {

using namespace taut_test;
using std::chrono::milliseconds;

#ifdef TAUT_SANITIZED
constexpr int slowdown = 10;
#else
constexpr int slowdown = 1;
#endif

/// What goes on longer hangs.
constexpr unsigned longest_seconds = 10 * slowdown;
/// For how long most models are tried, and every tenth.
constexpr milliseconds short_limit(50 * slowdown);
constexpr milliseconds long_limit(1000 * slowdown);
/// Of a process, in bytes. Sanitizers reserve more than there is.
constexpr rlim_t most_memory = rlim_t(4) << 30U;

constexpr int finding_status = 99;

/// What the process that tries says to the one that waits.
struct Shared {
  std::atomic<std::uint64_t> at;
  std::atomic<std::uint64_t> accepted, refused, stopped;
  char what[1000];
};

using Maker = RandomModel (*)(std::uint64_t);

std::string name_of(const std::string& kind, std::uint64_t seed, const RandomModel& model) {
  return "finding_" + kind + "_" + std::to_string(seed) + model.reader.format;
}

/// Tries one after the other until one is a finding, and then exits.
[[noreturn]] void try_all(const std::string& kind, Maker make, std::uint64_t end, Shared& shared) {
#ifndef TAUT_SANITIZED
  const rlimit memory = {most_memory, most_memory};
  setrlimit(RLIMIT_AS, &memory);
#endif
  for (; shared.at < end; ++shared.at) {
    const std::uint64_t seed = shared.at;
    alarm(longest_seconds);
    const RandomModel model = make(seed);
    try {
      const Outcome outcome = read_one(model.reader, model.text, name_of(kind, seed, model),
                                       seed % 10 == 0 ? long_limit : short_limit);
      ++(outcome.stopped ? shared.stopped : outcome.accepted ? shared.accepted : shared.refused);
    } catch (const std::exception& finding) {
      std::strncpy(shared.what, finding.what(), sizeof shared.what - 1);
      std::_Exit(finding_status);
    }
  }
  std::_Exit(0);
}

std::string what_became_of(int status, const Shared& shared) {
  if (WIFSIGNALED(status)) {
    if (WTERMSIG(status) == SIGALRM) return "hangs";
    return std::string("dies by signal ") + strsignal(WTERMSIG(status));
  }
  if (WEXITSTATUS(status) == finding_status) return shared.what;
  return "exits with " + std::to_string(WEXITSTATUS(status));
}

std::vector<RandomModel>& all_gluings() {
  static std::vector<RandomModel> all;
  return all;
}

void make_gluings() {
  const std::vector<std::vector<int>> sizes = {
      {3}, {4}, {3, 3}, {3, 4}, {4, 4}, {3, 3, 3}, {3, 3, 4}, {3, 4, 4}, {4, 4, 4}, {3, 3, 3, 3}};
  for (const std::vector<int>& of : sizes) {
    each_gluing(of, [&](const std::vector<std::vector<int>>& faces) {
      all_gluings().push_back(cage_of_gluing(faces, taut::Scheme::catmark));
      if (of.back() == 3) all_gluings().push_back(cage_of_gluing(faces, taut::Scheme::loop));
    });
  }
}

RandomModel gluing(std::uint64_t number) { return all_gluings()[number]; }

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc == 4 ? argv[1] : "";
  Maker make = nullptr;
  if (kind == "cages") make = random_cage;
  if (kind == "surfaces") make = random_surfaces;
  if (kind == "gluings") make = gluing;
  if (make == nullptr) {
    std::cerr << "try_models cages|surfaces|gluings FIRST COUNT\n";
    return 2;
  }
  const std::uint64_t first = std::strtoull(argv[2], nullptr, 10);
  std::uint64_t end = first + std::strtoull(argv[3], nullptr, 10);
  if (kind == "gluings") {
    make_gluings();
    end = std::min<std::uint64_t>(end, all_gluings().size());
  }
  void* const memory =
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return 3;
  Shared& shared = *new (memory) Shared{};
  shared.at = first;
  const auto start = std::chrono::steady_clock::now();
  int findings = 0;
  while (shared.at < end) {
    const pid_t child = fork();
    if (child < 0) return 3;
    if (child == 0) try_all(kind, make, end, shared);
    int status = 0;
    waitpid(child, &status, 0);
    if (status == 0) break;
    ++findings;
    const std::uint64_t seed = shared.at;
    const RandomModel model = make(seed);
    const std::string file = name_of(kind, seed, model);
    std::ofstream(file) << model.text;
    std::cout << file << ": " << what_became_of(status, shared) << std::endl;
    ++shared.at;
  }
  const std::chrono::duration<double, std::ratio<60>> minutes =
      std::chrono::steady_clock::now() - start;
  std::cout << end - first << " " << kind << " from " << first << ": " << shared.accepted
            << " read and their hulls found, " << shared.refused << " refused, " << shared.stopped
            << " stopped, " << findings << " findings, " << minutes.count() << " minutes\n";
  return findings == 0 ? 0 : 1;
}
