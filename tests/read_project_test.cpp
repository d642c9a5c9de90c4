// Reader of MeshLab projects, .mlp.

#include <cmath>
#include <random>
#include <vector>

#include "taut/io/model/read_model.h"
#include "temporary_folder.h"

namespace {

using taut::dvec3;
using taut::InvalidInput;
using taut::IoError;
using taut::Model;
using taut_test::message_of;

using Points = std::vector<dvec3>;

/// A layer of the file as MeshLab writes it; further attributes where `more` has them.
std::string layer(const std::string& file, const std::string& matrix,
                  const std::string& more = "visible=\"1\"") {
  std::string text = "  <MLMesh filename=\"" + file + "\" label=\"the " + file + "\" " + more +
                     " idInFile=\"-1\">\n";
  if (!matrix.empty()) text += "   <MLMatrix44>\n" + matrix + "</MLMatrix44>\n";
  return text + "   <RenderingOption pointSize=\"3\">100001000</RenderingOption>\n  </MLMesh>\n";
}

/// The first layer begins on line 4.
std::string project(const std::string& layers) {
  return "<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n <MeshGroup>\n" + layers +
         " </MeshGroup>\n <RasterGroup/>\n</MeshLabProject>\n";
}

const std::string at_rest = "1 0 0 0 \n0 1 0 0 \n0 0 1 0 \n0 0 0 1 \n";
/// A quarter turn about z, then a translation.
const std::string turned = "0 -1 0 10 \n1 0 0 20 \n0 0 1 30 \n0 0 0 1 \n";
const std::string stretched = "2 0 0 1 \n0 3 0 0 \n0 0 1 -1 \n0 0 0 1 \n";

class ReadProject : public taut_test::TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    file("a.xyz", "1 0 0\n0 2 0\n");
    file("b.off", "OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2");
  }

  Model read(const std::string& layers) const {
    Model model;
    taut::read_model(file("p.mlp", project(layers)), model, options_);
    return model;
  }
  /// The message after the project's name, of a project as it is given.
  template <class Error>
  std::string message(const std::string& text) const {
    Model model;
    taut::read_model("1 1 1", "before", ".xyz", model);
    const std::string what =
        message_of<Error>([&] { taut::read_model(file("p.mlp", text), model, options_); });
    EXPECT_EQ(model.parts().size(), 1U);
    EXPECT_EQ(model.instances().size(), 1U);
    EXPECT_EQ(model.vertex_count(), 1);
    const std::string name = path("p.mlp").string();
    EXPECT_TRUE(what.starts_with(name)) << what;
    EXPECT_EQ(what.find('\n'), what.npos) << what;
    return what.substr(std::min(name.size(), what.size()));
  }

  taut::ReadOptions options_;
};

/// The points of all instances where they stand.
Points placed_points(const Model& model) {
  Points points;
  for (const taut::Instance& instance : model.instances()) {
    for (const dvec3& p : model.parts()[static_cast<std::size_t>(instance.part)].vertices()) {
      points.push_back(instance.pose(p));
    }
  }
  return points;
}

TEST_F(ReadProject, Layers) {
  const Model model = read(layer("a.xyz", turned) + layer("b.off", ""));
  ASSERT_EQ(model.parts().size(), 2U);
  EXPECT_EQ(model.parts()[0].name, "a.xyz");
  EXPECT_EQ(model.parts()[1].name, "b.off");
  EXPECT_EQ(model.parts()[1].polygons().size(), 1U);
  EXPECT_EQ(placed_points(model),
            (Points{{10, 21, 30}, {8, 20, 30}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST_F(ReadProject, LayersOfOneFileAreInstances) {
  std::filesystem::create_directory(path("sub"));
  const Model model =
      read(layer("a.xyz", at_rest) + layer("b.off", at_rest) + layer("./sub/../a.xyz", turned));
  ASSERT_EQ(model.parts().size(), 2U);
  ASSERT_EQ(model.instances().size(), 3U);
  EXPECT_EQ(model.instances()[2].part, 0);
  EXPECT_EQ(placed_points(model)[5], dvec3(10, 21, 30));
}

TEST_F(ReadProject, MatricesThatAreNotRigid) {
  const std::string mirrored = "-1 0 0 0 \n0 1 0 0 \n0 0 1 0 \n0 0 0 1 \n";
  const Model model = read(layer("a.xyz", stretched) + layer("a.xyz", at_rest) +
                           layer("a.xyz", mirrored) + layer("a.xyz", turned));
  ASSERT_EQ(model.parts().size(), 3U);
  ASSERT_EQ(model.instances().size(), 4U);
  EXPECT_EQ(placed_points(model), (Points{{3, 0, -1},
                                          {1, 6, -1},
                                          {1, 0, 0},
                                          {0, 2, 0},
                                          {-1, 0, 0},
                                          {0, 2, 0},
                                          {10, 21, 30},
                                          {8, 20, 30}}));
  EXPECT_EQ(model.parts()[0].name, "a.xyz");
}

TEST_F(ReadProject, ShearedSurfacesCurvesAndPolygons) {
  // Several pieces, weights and loops; the same with its control points sheared by hand.
  const auto obj = [](bool sheared) {
    std::string text;
    for (int i = 0; i < 20; ++i) {
      const int x = i * 3 % 7, y = i * i % 11, z = i;
      const int image[3] = {x + 2 * y + 5, y - 3, z + x};
      text += "v " + std::to_string(sheared ? image[0] : x) + " " +
              std::to_string(sheared ? image[1] : y) + " " +
              std::to_string(sheared ? image[2] : z) + " " + std::to_string(1 << (i % 3)) + "\n";
    }
    return text +
           "vp .25 .25\nvp .75 .25\nvp .5 .75\nf 1 2 3 4\np 5\n"
           "cstype bezier\ndeg 1 1\ncurv2 1 2 3 1\nparm u 0 1 2 3\nend\ncstype rat bezier\n"
           "deg 2 1\ng lid\n"
           "surf 0 3 0 1 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20\n"
           "parm u 0 1 3\nparm v 0 .25 .5 1\ntrim 0 3 1\nend\ncstype rat bspline\ndeg 3\n"
           "curv 0.5 3.5 1 2 3 4 5 6 7\nparm u 0 0 0 0 1 2 3 4 4 4 4\nend\n";
  };
  file("s.obj", obj(false));
  const Model model = read(layer("s.obj", "1 2 0 5 \n0 1 0 -3 \n1 0 1 0 \n0 0 0 1 \n"));
  Model expected;
  taut::read_model(obj(true), "s.obj", ".obj", expected);
  ASSERT_EQ(model.parts().size(), 1U);
  const taut::Part& a = model.parts()[0];
  const taut::Part& b = expected.parts()[0];
  ASSERT_EQ(a.patches().size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(a.patches()[i].bezier.points, b.patches()[i].bezier.points);
    EXPECT_EQ(a.patches()[i].u.upper, b.patches()[i].u.upper);
    EXPECT_EQ(a.patches()[i].v.lower, b.patches()[i].v.lower);
  }
  ASSERT_EQ(a.pieces().size(), b.pieces().size());
  for (std::size_t i = 0; i < a.pieces().size(); ++i) {
    for (std::size_t k = 0; k < a.pieces()[i].bezier.points.size(); ++k) {
      EXPECT_LT(glm::length(a.pieces()[i].bezier.points[k] - b.pieces()[i].bezier.points[k]),
                1e-13);
    }
    EXPECT_EQ(a.pieces()[i].t.upper, b.pieces()[i].t.upper);
  }
  EXPECT_EQ(a.polygons(), b.polygons());
  ASSERT_EQ(a.point_count(), 5);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(a.vertices()[i], b.vertices()[i]);
  EXPECT_EQ(a.faces()[0].name, "lid");
  ASSERT_EQ(a.faces()[0].loops.size(), 1U);
  EXPECT_EQ(a.faces()[0].loops[0].curves[0].points, b.faces()[0].loops[0].curves[0].points);
}

TEST_F(ReadProject, KeepsWhatTheModelHas) {
  Model model;
  taut::read_model(path("b.off"), model);
  model.add_instance(0, {taut::dmat3(1.0), {0, 0, 7}});
  taut::read_model(file("p.mlp", project(layer("a.xyz", turned))), model);
  ASSERT_EQ(model.instances().size(), 3U);
  EXPECT_EQ(model.instances()[1].pose.translation, dvec3(0, 0, 7));
  EXPECT_EQ(model.instances()[2].part, 1);
  EXPECT_EQ(model.vertex_count(), 8);
}

TEST_F(ReadProject, FromMemoryBesideItsName) {
  Model model;
  taut::read_model(project(layer("a.xyz", "")), path("nowhere.mlp").string(), ".mlp", model);
  EXPECT_EQ(model.vertex_count(), 2);
  taut::read_model(project(layer(path("a.xyz").string(), "")), "standard input", ".mlp", model);
  EXPECT_EQ(model.vertex_count(), 4);
}

TEST_F(ReadProject, LayersThatAreLeftOut) {
  std::vector<std::string> warnings;
  options_.progress.warn = [&](std::string_view code, std::string_view text) {
    warnings.push_back(std::string(code) + " " + std::string(text));
  };
  std::string text = project(layer("none.ply", "", "visible=\"0\"") + layer("a.xyz", ""));
  text.replace(text.find("<RasterGroup/>"), 14, "<RasterGroup><MLRaster/></RasterGroup>");
  Model model;
  taut::read_model(file("p.mlp", text), model, options_);
  EXPECT_EQ(model.parts().size(), 1U);
  const std::string name = path("p.mlp").string();
  EXPECT_EQ(warnings,
            (std::vector<std::string>{"invisible-layer " + name +
                                          ":4: layer \"the none.ply\" is not visible and left out",
                                      "raster-layer " + name + ":11: rasters are left out"}));
}

TEST_F(ReadProject, WithCarriageReturns) {
  std::string text = project(layer("a.xyz", turned));
  for (std::size_t i = 0; (i = text.find('\n', i)) != text.npos; i += 2) text.insert(i, 1, '\r');
  Model model;
  taut::read_model(file("p.mlp", text), model);
  EXPECT_EQ(placed_points(model)[0], dvec3(10, 21, 30));
}

TEST_F(ReadProject, ThatIsNotItsFormat) {
  EXPECT_EQ(message<IoError>(""), ":1: is no XML: No document element found");
  EXPECT_EQ(message<IoError>("<MeshLabProject>\n<MeshGroup>\n</MeshLabProject>"),
            ":3: is no XML: Start-end tags mismatch");
  EXPECT_EQ(message<IoError>("\n<html/>"), ":2: MeshLabProject expected, found \"html\"");
  EXPECT_EQ(message<IoError>(project("<MLMesh/>")), ":4: a layer has no filename");
  EXPECT_EQ(message<IoError>(project(layer("a.xyz", "1 0 0"))),
            ":5: MLMatrix44 has 3 numbers, not 16");
  EXPECT_EQ(message<IoError>(project(layer("a.xyz", at_rest + "0"))),
            ":5: MLMatrix44 has more than 16 numbers");
  EXPECT_EQ(message<IoError>(project(layer("a.xyz", "1 0 0 0\n0 one 0 0\n"))),
            ":7: a number expected, found \"one\"");
  // The binary form has its numbers as bytes.
  EXPECT_EQ(message<IoError>(project(layer("a.xyz", "AACAPwAAAAAAAAA="))),
            ":6: a number expected, found \"AACAPwAAAAAAAAA=\"");
  std::string second = layer("a.xyz", "");
  second.replace(second.find("-1"), 2, "1");
  EXPECT_EQ(message<IoError>(project(second)),
            ":4: layer \"the a.xyz\": idInFile \"1\" where files hold one layer");
}

TEST_F(ReadProject, ThatIsNoGeometry) {
  EXPECT_EQ(message<InvalidInput>(project("")), ":2: the project has no layers");
  EXPECT_EQ(message<InvalidInput>(project(layer("a.xyz", "", "visible=\"0\""))),
            ":2: the project has no layers that are visible");
  EXPECT_EQ(message<InvalidInput>(project(layer("a.xyz", "1 0 nan 0\n"))),
            ":6: a number is not finite: \"nan\"");
  EXPECT_EQ(message<InvalidInput>(project(layer("a.xyz", "1 0 0 1e999\n"))),
            ":6: a number is too large: \"1e999\"");
  EXPECT_EQ(message<InvalidInput>(
                project(layer("b.off", "") + layer("a.xyz", "1 2 3 0 4 5 6 0 5 7 9 0 0 0 0 1"))),
            ":8: MLMatrix44 is singular");
  EXPECT_EQ(message<InvalidInput>(project(layer("a.xyz", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0.5 1"))),
            ":5: the last row of MLMatrix44 is not 0 0 0 1");
  EXPECT_EQ(message<InvalidInput>(project(layer("a.xyz", "1 0 0 0 0 1e308 0 0 0 0 1 0 0 0 0 1"))),
            ":4: layer \"the a.xyz\": a.xyz: point 1 is not finite");
}

TEST_F(ReadProject, LayersThatCannotBeRead) {
  const std::string good = layer("a.xyz", "");  // four lines
  const auto of = [&](const std::string& name) {
    return ":7: layer \"the " + name + "\": " + path(name).string();
  };
  EXPECT_EQ(message<IoError>(project(good + layer("none.ply", ""))),
            of("none.ply") + ": cannot be opened: No such file or directory");
  EXPECT_EQ(message<IoError>(project(good + layer("a.step", ""))),
            of("a.step") + ": no format of layers has the extension \".step\"");
  std::filesystem::create_directory(path("folder.ply"));
  EXPECT_EQ(message<IoError>(project(good + layer("folder.ply", ""))),
            of("folder.ply") + ": is no file");
  file("bad.off", "OFF 1 0 0\n0 zero 0\n");
  EXPECT_EQ(message<IoError>(project(good + layer("bad.off", ""))),
            of("bad.off") + ":2: a coordinate expected, found \"zero\"");
  file("nan.off", "OFF 1 0 0\n0 nan 0\n");
  EXPECT_EQ(message<InvalidInput>(project(good + layer("nan.off", ""))),
            of("nan.off") + ":2: a coordinate is not finite: \"nan\"");
  std::filesystem::resize_file(file("huge.ply", "ply\n"), (std::uintmax_t{1} << 31) + 1);
  EXPECT_EQ(message<taut::LimitExceeded>(project(good + layer("huge.ply", ""))),
            of("huge.ply") + ": is larger than 2048 MiB, the most that is read");
}

TEST_F(ReadProject, WithinAProjectIsRefused) {
  EXPECT_EQ(message<IoError>(project(layer("p.mlp", ""))),
            ":4: layer \"the p.mlp\": " + path("p.mlp").string() +
                ": a project within a project is not read");
}

TEST_F(ReadProject, EntitiesAreNotExpanded) {
  std::string bomb = "<!DOCTYPE b [\n<!ENTITY e0 \"a.xyz\">\n";
  for (int i = 1; i < 40; ++i) {
    const std::string last = "&e" + std::to_string(i - 1) + ";";
    bomb += "<!ENTITY e" + std::to_string(i) + " \"" + last + last + last + "\">\n";
  }
  bomb += "<!ENTITY f SYSTEM \"a.xyz\">]>\n<MeshLabProject><MeshGroup><MLMesh filename=\"";
  const std::string end = "\"/></MeshGroup></MeshLabProject>";
  EXPECT_EQ(message<IoError>(bomb + "&e39;" + end),
            ":43: layer \"&e39;\": " + path("&e39;").string() +
                ": no format of layers has the extension \"\"");
  EXPECT_EQ(message<IoError>(bomb + "&f;.ply" + end),
            ":43: layer \"&f;.ply\": " + path("&f;.ply").string() +
                ": cannot be opened: No such file or directory");
}

TEST_F(ReadProject, FileRepeatedUnderOtherMatrices) {
  std::string polygon = "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n1048575";
  for (int i = 0; i < 1048575; ++i) polygon += i % 3 == 0 ? " 0" : i % 3 == 1 ? " 1" : " 2";
  file("large.off", polygon);
  std::string layers;
  for (int i = 0; i < 70; ++i) layers += layer("large.off", stretched);
  const std::string what = message<taut::LimitExceeded>(project(layers));
  EXPECT_NE(what.find("more than 67108864 control points"), std::string::npos) << what;
}

TEST_F(ReadProject, NamesOfFilesWithControlCharacters) {
  EXPECT_EQ(message<IoError>(project(layer("a&#10;&#27;.ply", ""))),
            ":4: layer \"the a??.ply\": " + path("a??.ply").string() +
                ": the name has control characters or is too long");
}

TEST_F(ReadProject, LayersTooFarApart) {
  file("far.xyz", "1.7e308 0 0\n");
  const auto there = [&](const std::string& x) {
    return layer("far.xyz", "1 0 0 " + x + " 0 1 0 0 0 0 1 0 0 0 0 1");
  };
  const std::string what = message<InvalidInput>(project(there("0") + there("1.7e308")));
  EXPECT_TRUE(what.ends_with("the extent overflows")) << what;
}

TEST_F(ReadProject, DeepAndLargeDocuments) {
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  EXPECT_TRUE(message<IoError>(deep).starts_with(":1: is no XML"));
  const std::string large((std::size_t{1} << 26) + 1, ' ');
  EXPECT_EQ(message<taut::LimitExceeded>(large),
            ": is larger than 64 MiB, the most that a project may have");
  // Many lines and warnings: would take minutes if each were looked for from the beginning.
  std::string many;
  for (int i = 0; i < 400000; ++i) many += "<MLMesh visible=\"0\"/>\n";
  EXPECT_TRUE(message<InvalidInput>(project(many)).ends_with("no layers that are visible"));
}

TEST_F(ReadProject, DamagedFiles) {
  const std::string text = project(layer("a.xyz", turned) + layer("b.off", stretched));
  const auto expect_read_or_refused = [&](const std::string& damaged) {
    Model model;
    try {
      taut::read_model(damaged, path("p.mlp").string(), ".mlp", model);
    } catch (const taut::Error& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(path("p.mlp").string())) << error.what();
      EXPECT_TRUE(model.parts().empty());
    }
  };
  for (std::size_t length = 0; length < text.size(); ++length) {
    expect_read_or_refused(text.substr(0, length));
  }
  std::mt19937 random(6);
  for (int k = 0; k < 2000; ++k) {
    std::string damaged = text;
    for (int n = 0; n <= k % 4; ++n) {
      damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    }
    expect_read_or_refused(damaged);
  }
}

}  // namespace
