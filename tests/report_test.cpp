// The JSON report.

#include "taut/io/report/report.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::ordered_json;

taut::Report full_report() {
  taut::Report report;
  report.input.files = {"a.bpt"};
  report.input.faces = 32;
  report.input.edges = 3;
  report.input.vertices = 2;
  report.input.patches = 33;
  report.input.diagonal = 0.1;
  report.input.box.include(taut::dvec3(-1, 0, 1.0 / 3));
  report.input.box.include(taut::dvec3(1, 2, 3));
  report.method = "precise";
  report.hull.counts = {10, 11, 12, 13, 1};
  taut::Resolution& resolution = report.hull.resolution.emplace();
  resolution.rho = 2e-7;
  resolution.source = taut::ResolutionSource::stand_ins;
  report.hull.tolerant = {3, 1e-8};
  taut::Measures& measures = report.hull.measures.emplace();
  measures.volume = 0.3;
  measures.area = 1.0 / 7;
  measures.centroid = taut::dvec3(1, 2, 0.7);
  measures.inertia = taut::dmat3(1, 2, 3, 2, 4, 5, 3, 5, 0.6);
  report.hull.mean_width = 0.9;
  report.hull.measures_accuracy = 1e-11;
  report.hull.gap_bound = 1e-7;
  report.mesh.vertices = 5'000'000'000;
  report.mesh.edges = 9;
  report.mesh.faces = 6;
  report.mesh.measures.volume = 32.67038;
  report.mesh.measures.area = 53.66226;
  report.mesh.tolerance = 5e-324;
  report.mesh.distance_bound = 1.7976931348623157e308;
  report.mesh.files = {{"a.ply", 0}, {"b.stl", 0.1}};
  report.culling = {1000, 10, 2};
  report.directions = {2000, 50, 3};
  report.queries = {7, 8};
  report.seconds = {1, 2, 3, 4, 5, 6, 7, 8, 9, 55.5};
  report.peak_bytes = 1L << 40;
  report.warnings = {{"open-border", "an \"open\" border"}};
  return report;
}

std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> result;
  for (const auto& [key, value] : json.items()) result.push_back(key);
  return result;
}

using Keys = std::vector<std::string>;

TEST(Report, KeysOfTheContractInOrder) {
  const Json json = Json::parse(to_json(full_report()));
  EXPECT_EQ(keys(json), (Keys{"taut", "input", "method", "dimension", "hull", "mesh", "culling",
                              "directions", "queries", "seconds", "peak_bytes", "warnings"}));
  EXPECT_EQ(keys(json["input"]), (Keys{"files", "faces", "edges", "vertices", "patches", "diagonal",
                                       "box", "curves", "points", "unit"}));
  EXPECT_EQ(keys(json["hull"]),
            (Keys{"patches", "scrolls", "facets", "curves", "unresolved", "resolution",
                  "resolution_source", "tolerant", "tolerant_bound", "volume", "area", "centroid",
                  "inertia", "mean_width", "measures_accuracy", "gap_bound"}));
  EXPECT_EQ(keys(json["mesh"]), (Keys{"vertices", "edges", "faces", "volume", "area", "tolerance",
                                      "distance_bound", "files"}));
  for (const Json& f : json["mesh"]["files"]) EXPECT_EQ(keys(f), (Keys{"file", "rounding"}));
  EXPECT_EQ(keys(json["culling"]), (Keys{"leaves", "kept", "searched"}));
  EXPECT_EQ(keys(json["directions"]), (Keys{"cells", "candidates", "undecided"}));
  EXPECT_EQ(keys(json["queries"]), (Keys{"support", "newton_iterations"}));
  EXPECT_EQ(keys(json["seconds"]), (Keys{"read", "build", "sample", "cull", "trace", "stitch",
                                         "mesh", "measure", "write", "total"}));
}

TEST(Report, ValuesRoundTrip) {
  const taut::Report report = full_report();
  const Json json = Json::parse(to_json(report));
  EXPECT_EQ(json["input"]["files"], Json({"a.bpt"}));
  EXPECT_EQ(json["input"]["faces"], 32);
  EXPECT_EQ(json["input"]["edges"], 3);
  EXPECT_EQ(json["input"]["vertices"], 2);
  EXPECT_EQ(json["input"]["patches"], 33);
  EXPECT_EQ(json["input"]["diagonal"].get<double>(), 0.1);
  EXPECT_EQ(json["input"]["box"].size(), 2U);
  EXPECT_EQ(json["input"]["box"][0][2].get<double>(), 1.0 / 3);
  EXPECT_EQ(json["input"]["box"][1], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(json["method"], "precise");
  EXPECT_EQ(json["dimension"], 3);
  EXPECT_EQ(json["hull"]["patches"], 10);
  EXPECT_EQ(json["hull"]["scrolls"], 11);
  EXPECT_EQ(json["hull"]["facets"], 12);
  EXPECT_EQ(json["hull"]["curves"], 13);
  EXPECT_EQ(json["hull"]["unresolved"], 1);
  EXPECT_EQ(json["hull"]["resolution"].get<double>(), 2e-7);
  EXPECT_EQ(json["hull"]["resolution_source"], "stand-ins");
  EXPECT_EQ(json["hull"]["tolerant"], 3);
  EXPECT_EQ(json["hull"]["tolerant_bound"].get<double>(), 1e-8);
  EXPECT_EQ(json["hull"]["volume"].get<double>(), 0.3);
  EXPECT_EQ(json["hull"]["area"].get<double>(), 1.0 / 7);
  EXPECT_EQ(json["hull"]["centroid"], Json({1.0, 2.0, 0.7}));
  EXPECT_EQ(json["hull"]["inertia"], Json({{1.0, 2.0, 3.0}, {2.0, 4.0, 5.0}, {3.0, 5.0, 0.6}}));
  EXPECT_EQ(json["hull"]["mean_width"].get<double>(), 0.9);
  EXPECT_EQ(json["hull"]["gap_bound"].get<double>(), 1e-7);
  EXPECT_EQ(json["mesh"]["vertices"], 5'000'000'000);
  EXPECT_EQ(json["mesh"]["edges"], 9);
  EXPECT_EQ(json["mesh"]["faces"], 6);
  EXPECT_EQ(json["mesh"]["volume"].get<double>(), 32.67038);
  EXPECT_EQ(json["mesh"]["area"].get<double>(), 53.66226);
  EXPECT_EQ(json["mesh"]["tolerance"].get<double>(), 5e-324);
  EXPECT_EQ(json["mesh"]["distance_bound"].get<double>(), 1.7976931348623157e308);
  ASSERT_EQ(json["mesh"]["files"].size(), 2U);
  EXPECT_EQ(json["mesh"]["files"][0]["file"], "a.ply");
  EXPECT_EQ(json["mesh"]["files"][0]["rounding"].get<double>(), 0);
  EXPECT_EQ(json["mesh"]["files"][1]["file"], "b.stl");
  EXPECT_EQ(json["mesh"]["files"][1]["rounding"].get<double>(), 0.1);
  EXPECT_EQ(json["culling"], Json({{"leaves", 1000}, {"kept", 10}, {"searched", 2}}));
  EXPECT_EQ(json["directions"], Json({{"cells", 2000}, {"candidates", 50}, {"undecided", 3}}));
  EXPECT_EQ(json["queries"], Json({{"support", 7}, {"newton_iterations", 8}}));
  EXPECT_EQ(json["seconds"]["read"], 1.0);
  EXPECT_EQ(json["seconds"]["build"], 2.0);
  EXPECT_EQ(json["seconds"]["sample"], 3.0);
  EXPECT_EQ(json["seconds"]["cull"], 4.0);
  EXPECT_EQ(json["seconds"]["trace"], 5.0);
  EXPECT_EQ(json["seconds"]["stitch"], 6.0);
  EXPECT_EQ(json["seconds"]["mesh"], 7.0);
  EXPECT_EQ(json["seconds"]["measure"], 8.0);
  EXPECT_EQ(json["seconds"]["write"], 9.0);
  EXPECT_EQ(json["seconds"]["total"], 55.5);
  EXPECT_EQ(json["peak_bytes"], 1L << 40);
  ASSERT_EQ(json["warnings"].size(), 1U);
  EXPECT_EQ(json["warnings"][0]["code"], "open-border");
  EXPECT_EQ(json["warnings"][0]["text"], "an \"open\" border");
}

TEST(Report, WhatIsNotKnownIsAbsent) {
  const Json json = Json::parse(to_json(taut::Report{}));
  EXPECT_TRUE(json["hull"].is_object());
  EXPECT_TRUE(json["hull"].empty());
  EXPECT_FALSE(json["input"].contains("box"));
  EXPECT_FALSE(json.contains("culling"));
  EXPECT_TRUE(json["input"]["files"].is_array());
  EXPECT_TRUE(json["warnings"].is_array());
  EXPECT_TRUE(json["warnings"].empty());
}

TEST(Report, ListsOfAnyLengthStayLists) {
  taut::Report report;
  for (int n = 0; n < 4; ++n) {
    const Json json = Json::parse(to_json(report));
    ASSERT_TRUE(json["input"]["files"].is_array());
    EXPECT_EQ(json["input"]["files"].size(), static_cast<std::size_t>(n));
    ASSERT_TRUE(json["warnings"].is_array());
    ASSERT_EQ(json["warnings"].size(), static_cast<std::size_t>(n));
    for (const Json& warning : json["warnings"]) EXPECT_EQ(keys(warning), (Keys{"code", "text"}));
    ASSERT_TRUE(json["mesh"]["files"].is_array());
    ASSERT_EQ(json["mesh"]["files"].size(), static_cast<std::size_t>(n));
    for (const Json& f : json["mesh"]["files"]) EXPECT_EQ(keys(f), (Keys{"file", "rounding"}));
    report.input.files.push_back("file");
    report.warnings.push_back({"code", "text"});
    report.mesh.files.push_back({"file", 0});
  }
}

TEST(Report, AnyBytesInNames) {
  taut::Report report;
  report.input.files = {"\xff\xfe.bpt", "tab\t\"quote\"\n", "\xc3\xbc"};
  const Json json = Json::parse(to_json(report));
  EXPECT_EQ(json["input"]["files"][1], "tab\t\"quote\"\n");
  EXPECT_EQ(json["input"]["files"][2], "\xc3\xbc");
}

TEST(Report, WhatIsNotFiniteIsNull) {
  taut::Report report;
  report.mesh.distance_bound = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(Json::parse(to_json(report))["mesh"]["distance_bound"].is_null());
}

TEST(Report, IndentsByTwo) {
  const std::string text = to_json(full_report());
  EXPECT_TRUE(text.starts_with("{\n  \"taut\": \"")) << text;
  EXPECT_TRUE(text.ends_with("\n}\n"));
  EXPECT_NE(text.find("\n  \"input\": {\n    \"files\": ["), text.npos);
}

}  // namespace
