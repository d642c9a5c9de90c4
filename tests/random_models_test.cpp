// The generators of models at random, and a few of their models.

#include "fuzz/random_models.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace taut_test {
namespace {

using Faces = std::vector<std::vector<int>>;

/// Vertices in the order in which they are met.
Faces renumbered(const Faces& faces) {
  std::vector<int> met;
  Faces result = faces;
  for (std::vector<int>& face : result) {
    for (int& v : face) {
      const auto found = std::find(met.begin(), met.end(), v);
      if (found == met.end()) met.push_back(v);
      v = int(std::find(met.begin(), met.end(), v) - met.begin());
    }
  }
  return result;
}

/// All cages that are the same but for the order of the two faces, if they are of one size, and for
/// where they begin.
std::set<Faces> same_as(const Faces& faces) {
  std::set<Faces> result;
  for (const bool swapped : {false, true}) {
    if (swapped && faces[0].size() != faces[1].size()) continue;
    Faces turned = faces;
    if (swapped) std::swap(turned[0], turned[1]);
    for (std::size_t i = 0; i < turned[0].size(); ++i) {
      std::rotate(turned[0].begin(), turned[0].begin() + 1, turned[0].end());
      for (std::size_t k = 0; k < turned[1].size(); ++k) {
        std::rotate(turned[1].begin(), turned[1].begin() + 1, turned[1].end());
        result.insert(renumbered(turned));
      }
    }
  }
  return result;
}

/// Each way in which corners can be the same is that of one cage: there are as many as the Bell
/// number of the corners.
TEST(EachGluing, OfTwoFaces) {
  const std::vector<std::pair<std::vector<int>, std::size_t>> bell = {
      {{3, 3}, 203}, {{3, 4}, 877}, {{4, 4}, 4140}};
  for (const auto& [sizes, count] : bell) {
    std::set<Faces> all;
    std::size_t sum = 0;
    each_gluing(sizes, [&](const Faces& faces) {
      const std::set<Faces> same = same_as(faces);
      sum += same.size();
      all.insert(same.begin(), same.end());
    });
    EXPECT_EQ(sum, count);
    EXPECT_EQ(all.size(), count);
  }
}

TEST(RandomModels, AreTheSameForTheSameSeed) {
  for (const std::uint64_t seed : {0, 1, 2}) {
    EXPECT_EQ(random_cage(seed).text, random_cage(seed).text);
    EXPECT_NE(random_cage(seed).text, random_cage(seed + 1).text);
    EXPECT_EQ(random_surfaces(seed).text, random_surfaces(seed).text);
    EXPECT_NE(random_surfaces(seed).text, random_surfaces(seed + 1).text);
  }
}

void expect_no_finding(const RandomModel& model) {
  try {
    read_one(model.reader, model.text, "model", std::chrono::milliseconds(20));
  } catch (const Finding& finding) {
    ADD_FAILURE() << finding.what() << "\n" << model.text;
  }
}

/// Two faces that share corners in all ways: back to back, folded, with vertices that repeat.
TEST(Gluings, OfTwoFacesAreReadOrRefused) {
  for (const std::vector<int>& sizes : {std::vector<int>{3, 3}, {3, 4}, {4, 4}}) {
    each_gluing(sizes, [&](const Faces& faces) {
      expect_no_finding(cage_of_gluing(faces, taut::Scheme::catmark));
      if (sizes[1] == 3) expect_no_finding(cage_of_gluing(faces, taut::Scheme::loop));
    });
  }
}

// The third of contacts in line was asked for where it no longer was.
TEST(RandomModels, ThatHaveCrashed) { expect_no_finding(random_surfaces(3319)); }

TEST(RandomModels, AreReadOrRefused) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    expect_no_finding(random_cage(seed));
    expect_no_finding(random_surfaces(seed));
  }
}

}  // namespace
}  // namespace taut_test
