// Readers of polygon meshes: PLY, OBJ, OFF, STL.

#include "taut/io/mesh/read_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "taut/core/error.h"
#include "temporary_folder.h"

namespace {

using taut::dvec3;
using taut::InvalidInput;
using taut::IoError;
using taut::PolygonMesh;
using taut_test::message_of;

using Polygons = std::vector<std::vector<int>>;

class ReadMesh : public taut_test::TemporaryFolder {
 protected:
  PolygonMesh read(const std::string& name, std::string_view text) const {
    return taut::read_mesh(file(name, text));
  }
  /// The message after "FILE".
  template <class Error>
  std::string message(const std::string& name, std::string_view text) const {
    return message_behind<Error>(name, [&] { read(name, text); });
  }
};

struct MalformedMesh {
  std::string text;
  std::string message;
};

/// A quad and a triangle over five points that need every bit of a double.
const std::vector<dvec3> points = {{0.1, 0, 1e-300},
                                   {1, 1.0 / 3, -0.0},
                                   {2.0 / 3, 1, 5e-324},
                                   {0, 1, 1.7976931348623157e308},
                                   {-1e22, 0.5, 0.30000000000000004}};
const Polygons polygons = {{0, 1, 2, 3}, {0, 3, 4}};

void expect_sample(const PolygonMesh& mesh) {
  EXPECT_EQ(mesh.points, points);
  EXPECT_EQ(mesh.polygons, polygons);
}

const std::string ascii_points =
    "0.1 0 1e-300\n1 0.33333333333333331 -0\n0.66666666666666663 1 5e-324\n"
    "0 1 1.7976931348623157e308\n-1e22 0.5 0.30000000000000004\n";

/// Bytes in a chosen order.
class OrderedBytes {
 public:
  explicit OrderedBytes(bool big_endian = false) : big_endian_(big_endian) {}

  template <class Number>
  OrderedBytes& operator<<(Number number) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
    const bool as_here = (std::endian::native == std::endian::big) == big_endian_;
    if (as_here) {
      text_.append(bytes.begin(), bytes.end());
    } else {
      text_.append(bytes.rbegin(), bytes.rend());
    }
    return *this;
  }
  const std::string& str() const { return text_; }

 private:
  bool big_endian_;
  std::string text_;
};

// ---------------------------------------------------------------- PLY

const std::string ply_vertices =
    "element vertex 5\nproperty double x\nproperty double y\nproperty double z\n";
const std::string ply_faces = "element face 2\nproperty list uchar int vertex_indices\n";

TEST_F(ReadMesh, PlyAscii) {
  expect_sample(read("a.ply", "ply\nformat ascii 1.0\ncomment element vertex 7\nobj_info x\n" +
                                  ply_vertices + ply_faces + "end_header\n" + ascii_points +
                                  "4 0 1 2 3\n3 0 3 4\n"));
}

TEST_F(ReadMesh, PlyAsciiWithCarriageReturns) {
  std::string text = "ply\nformat ascii 1.0\n" + ply_vertices + ply_faces + "end_header\n" +
                     ascii_points + "4 0 1 2 3\n3 0 3 4\n";
  for (std::size_t i = 0; (i = text.find('\n', i)) != text.npos; i += 2) text.insert(i, 1, '\r');
  expect_sample(read("a.ply", text));
}

TEST_F(ReadMesh, PlyAsciiPassesOverTheRest) {
  expect_sample(read("a.ply",
                     "ply\nformat ascii 1.0\nelement camera 1\nproperty float fov\n"
                     "property list uchar float k\nelement nothing 4\nelement vertex 5\n"
                     "property uchar red\nproperty double z\nproperty list int int ring\n"
                     "property double y\nproperty double x\nproperty float quality\n"
                     "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
                     "element face 2\nproperty uchar red\nproperty list uint8 uint32 vertex_index\n"
                     "property list uchar float texcoord\nend_header\n"
                     "45 2 nan 1.5\n"
                     "255 1e-300 0 0 0.1 nan\n0 -0 2 7 7 0.33333333333333331 1 inf\n"
                     "0 5e-324 0 1 0.66666666666666663 0\n0 1.7976931348623157e308 1 9 1 0 0\n"
                     "0 0.30000000000000004 0 0.5 -1e22 -1\n"
                     "0 1\n"
                     "9 4 0 1 2 3 0\n9 3 0 3 4 2 .5 .5\nrubbish at the end\n"));
}

std::string binary_ply(bool big_endian) {
  OrderedBytes bytes(big_endian);
  for (const dvec3& p : points) {
    bytes << std::uint8_t{7} << p.x << p.y << std::int16_t{-1} << p.z << std::uint16_t{2}
          << float{1} << float{2};
  }
  for (const auto& polygon : polygons) {
    bytes << 0.5 << static_cast<std::uint8_t>(polygon.size());
    for (const int corner : polygon) bytes << std::int32_t{corner};
    bytes << std::int8_t{3};
  }
  return std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
         "_endian 1.0\nelement vertex 5\nproperty uchar flag\nproperty double x\n"
         "property double y\nproperty short s\nproperty double z\n"
         "property list ushort float more\nelement face 2\nproperty float64 area\n"
         "property list uchar int vertex_indices\nproperty char c\nend_header\n" +
         bytes.str();
}

TEST_F(ReadMesh, PlyBinaryInBothOrders) {
  expect_sample(read("a.ply", binary_ply(false)));
  expect_sample(read("a.ply", binary_ply(true)));
}

template <class Number, class Length, class Index>
std::string typed_ply(bool big_endian, const std::string& number, const std::string& length,
                      const std::string& index) {
  OrderedBytes bytes(big_endian);
  for (const int x : {3, 5, 7, 11, 13, 17, 19, 23, 29}) bytes << static_cast<Number>(x);
  bytes << static_cast<Length>(3) << static_cast<Index>(2) << static_cast<Index>(0)
        << static_cast<Index>(1);
  return std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
         "_endian 1.0\nelement vertex 3\nproperty " + number + " x\nproperty " + number +
         " y\nproperty " + number + " z\nelement face 1\nproperty list " + length + " " + index +
         " vertex_indices\nend_header\n" + bytes.str();
}

TEST_F(ReadMesh, PlyBinaryTypes) {
  for (const bool big : {false, true}) {
    for (const std::string& text :
         {typed_ply<std::int8_t, std::int8_t, std::int8_t>(big, "char", "char", "char"),
          typed_ply<std::int8_t, std::int8_t, std::int8_t>(big, "int8", "int8", "int8"),
          typed_ply<std::uint8_t, std::uint8_t, std::uint8_t>(big, "uchar", "uchar", "uchar"),
          typed_ply<std::uint8_t, std::uint8_t, std::uint8_t>(big, "uint8", "uint8", "uint8"),
          typed_ply<std::int16_t, std::int16_t, std::int16_t>(big, "short", "short", "short"),
          typed_ply<std::int16_t, std::int16_t, std::int16_t>(big, "int16", "int16", "int16"),
          typed_ply<std::uint16_t, std::uint16_t, std::uint16_t>(big, "ushort", "ushort", "ushort"),
          typed_ply<std::uint16_t, std::uint16_t, std::uint16_t>(big, "uint16", "uint16", "uint16"),
          typed_ply<std::int32_t, std::int32_t, std::int32_t>(big, "int", "int", "int"),
          typed_ply<std::int32_t, std::int32_t, std::int32_t>(big, "int32", "int32", "int32"),
          typed_ply<std::uint32_t, std::uint32_t, std::uint32_t>(big, "uint", "uint", "uint"),
          typed_ply<std::uint32_t, std::uint32_t, std::uint32_t>(big, "uint32", "uint32", "uint32"),
          typed_ply<float, std::uint8_t, std::int32_t>(big, "float", "uchar", "int"),
          typed_ply<float, std::uint8_t, std::int32_t>(big, "float32", "uchar", "int"),
          typed_ply<double, std::uint8_t, std::int32_t>(big, "double", "uchar", "int"),
          typed_ply<double, std::uint8_t, std::int32_t>(big, "float64", "uchar", "int")}) {
      const PolygonMesh mesh = read("a.ply", text);
      EXPECT_EQ(mesh.points, (std::vector<dvec3>{{3, 5, 7}, {11, 13, 17}, {19, 23, 29}}));
      EXPECT_EQ(mesh.polygons, (Polygons{{2, 0, 1}}));
    }
  }
}

/// The sample in one of the three encodings, its coordinates as floats or doubles.
template <class Number>
std::string encoded_ply(const std::string& encoding, const std::string& number) {
  std::string text = "ply\nformat " + encoding + " 1.0\nelement vertex 5\nproperty " + number +
                     " x\nproperty " + number + " y\nproperty " + number +
                     " z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
  if (encoding == "ascii") return text + ascii_points + "4 0 1 2 3\n3 0 3 4\n";
  OrderedBytes bytes(encoding == "binary_big_endian");
  for (const dvec3& p : points) {
    for (int i = 0; i < 3; ++i) bytes << static_cast<Number>(p[i]);
  }
  for (const auto& polygon : polygons) {
    bytes << static_cast<std::uint8_t>(polygon.size());
    for (const int corner : polygon) bytes << std::int32_t{corner};
  }
  return text + bytes.str();
}

TEST_F(ReadMesh, PlyInEachEncodingAndPrecision) {
  for (const std::string encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    expect_sample(read("a.ply", encoded_ply<double>(encoding, "double")));
  }
  // What the file's text says in full; floats where they are bytes. (1.8e308 is no float.)
  expect_sample(read("a.ply", encoded_ply<float>("ascii", "float")));
  const std::vector<dvec3> rounded = {{0.1F, 1.0F / 3, -1e22F}, {1e-38F, 3e38F, 16777217.0F}};
  for (const bool big : {false, true}) {
    OrderedBytes bytes(big);
    for (const dvec3& p : rounded) {
      for (int i = 0; i < 3; ++i) bytes << static_cast<float>(p[i]);
    }
    const std::string text =
        std::string("ply\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
        "end_header\n" +
        bytes.str();
    EXPECT_EQ(read("a.ply", text).points, rounded);
  }
}

TEST_F(ReadMesh, PlyFacesMayComeFirst) {
  expect_sample(read("a.ply", "ply\nformat ascii 1.0\n" + ply_faces + ply_vertices +
                                  "end_header\n4 0 1 2 3\n3 0 3 4\n" + ascii_points));
}

TEST_F(ReadMesh, PlyOfPointsOnly) {
  const PolygonMesh mesh =
      read("a.ply", "ply\nformat ascii 1.0\n" + ply_vertices + "end_header\n" + ascii_points);
  EXPECT_EQ(mesh.points, points);
  EXPECT_TRUE(mesh.polygons.empty());
}

TEST_F(ReadMesh, PlyThatIsNotItsFormat) {
  const std::string ascii = "ply\nformat ascii 1.0\n";
  const std::string short_binary = binary_ply(true).substr(0, binary_ply(true).size() - 1);
  for (const auto& [text, expected] : std::vector<MalformedMesh>{
           {"", ":1: a PLY file begins with ply"},
           {"solid", ":1: a PLY file begins with ply"},
           {"ply\n", ":2: the file ends where end_header is expected"},
           {"ply\nend_header\n", ":2: the header has no format"},
           {"ply\nformat text 1.0\n", ":2: format \"text\" is not known"},
           {ascii + "element vertex\n", ":3: is no line of a PLY header: \"element\""},
           {ascii + "element vertex many\n", ":3: the number of elements expected, found \"many\""},
           {ascii + "property float x\n", ":3: is no line of a PLY header: \"property\""},
           {ascii + "element vertex 0\nproperty float\n", ":4: a property has a type and a name"},
           {ascii + "element vertex 0\nproperty half x\n", ":4: type \"half\" is not known"},
           {ascii + "element vertex 0\nproperty list float int l\n",
            ":4: the length of a list is no integer"},
           {ascii + "end_header\n", ":3: the header has no element vertex"},
           {ascii + ply_faces + "end_header\n00000000", ":5: the header has no element vertex"},
           {ascii + "element vertex 0\nproperty float x\nproperty float y\nend_header\n",
            ":3: vertices do not have one property z"},
           {ascii + "element vertex 0\nproperty float x\nproperty float x\nend_header\n",
            ":3: vertices do not have one property x"},
           {ascii + ply_vertices + ply_vertices + "end_header\n" + ascii_points + ascii_points,
            ":7: the element vertex stands here a second time"},
           {ascii + ply_vertices + "end_header\n0 0 0 0 0 0 0 0 0 0 0 0 0 0\n\n\n\n",
            ":12: the file ends where a coordinate is expected"},
           {ascii + ply_vertices + "end_header\n0 0 0 0\n0 0 0\n zero 0 0 0 0 0 0",
            ":10: a coordinate expected, found \"zero\""},
           {short_binary,
            ":byte " + std::to_string(short_binary.size()) + ": the file ends early"}}) {
    EXPECT_EQ(message<IoError>("a.ply", text), expected) << text;
  }
}

TEST_F(ReadMesh, PlyThatIsNoGeometry) {
  const std::string ascii = "ply\nformat ascii 1.0\n";
  const std::string body = ascii + ply_vertices + ply_faces + "end_header\n" + ascii_points;
  for (const auto& [text, expected] : std::vector<MalformedMesh>{
           {ascii + "element vertex -5\n", ":3: the number of elements is negative: \"-5\""},
           {ascii + "element vertex 1000000000\n",
            ":3: 1000000000 elements announced, more than the remaining 0 bytes can hold"},
           {ascii + ply_vertices + "end_header\n0 0 0\n",
            ":3: 5 of vertex announced, more than the remaining 6 bytes can hold"},
           {ascii + ply_vertices + "element face 1\nproperty uchar vertex_indices\nend_header\n" +
                ascii_points + "3\n",
            ":7: faces have no list of vertex_indices"},
           {body + "4 0 1 2 5\n3 0 3 4\n", ":15: vertex index 5 is not below 5"},
           {body + "4 0 1 2 3\n3 0 -1 4\n", ":16: vertex index -1 is not below 5"},
           {body + "4 0 1 2 3\n2 0 3\n", ":16: a face has fewer than three vertices"},
           {body + "-4 0 1 2 3\n3 0 3 4\n", ":15: the length of a list is negative: -4"},
           {body + "1000000000 0 1 2 3\n3 0 3 4\n",
            ":15: a list of 1000000000 does not fit into the file"},
           {ascii + ply_vertices + "end_header\n0 0 0\n0 nan 0\n0 0 0\n0 0 0\n0 0 0",
            ":9: a coordinate is not finite: \"nan\""}}) {
    EXPECT_EQ(message<InvalidInput>("a.ply", text), expected) << text;
  }
}

TEST_F(ReadMesh, PlyBinaryThatIsNoGeometry) {
  const std::string good = binary_ply(false);
  const std::size_t first_vertex = good.find("end_header\n") + 11;
  const auto damaged = [&](std::size_t at, const std::string& bytes) {
    std::string text = good;
    return text.replace(at, bytes.size(), bytes);
  };
  const std::size_t y = first_vertex + 9;
  const std::string at_y = ":byte " + std::to_string(y) + ": ";
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message<InvalidInput>("a.ply", damaged(y, (OrderedBytes() << nan).str())),
            at_y + "a coordinate is not finite");

  const std::size_t last_index = good.size() - 5;
  EXPECT_EQ(message<InvalidInput>("a.ply", damaged(last_index, (OrderedBytes() << 5).str())),
            ":byte " + std::to_string(last_index) + ": vertex index 5 is not below 5");
  EXPECT_EQ(message<InvalidInput>("a.ply", damaged(last_index, (OrderedBytes() << -1).str())),
            ":byte " + std::to_string(last_index) + ": vertex index -1 is not below 5");

  const std::size_t length = first_vertex + 27;
  EXPECT_EQ(message<InvalidInput>("a.ply",
                                  damaged(length, (OrderedBytes() << std::uint16_t{65535}).str())),
            ":byte " + std::to_string(length) + ": a list of 65535 does not fit into the file");

  const std::size_t count = good.find("vertex 5") + 7;
  EXPECT_EQ(message<InvalidInput>("a.ply", damaged(count, "9")),
            ":3: 9 of vertex announced, more than the remaining " +
                std::to_string(good.size() - first_vertex) + " bytes can hold");

  const std::string floats =
      typed_ply<float, std::uint8_t, float>(false, "float", "uchar", "float");
  EXPECT_EQ(message<InvalidInput>("a.ply", floats),
            ":byte " + std::to_string(floats.size() - 13) + ": an index is no integer");
}

TEST_F(ReadMesh, PlyFromElsewhere) {
  const char* folder = std::getenv("TAUT_MODELS");
  if (folder == nullptr) GTEST_SKIP() << "TAUT_MODELS is not set";
  const std::filesystem::path path = std::filesystem::path(folder) / "A20_cube_binary.ply";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const PolygonMesh mesh = taut::read_mesh(path);
  EXPECT_EQ(mesh.points.size(), 8U);
  EXPECT_EQ(mesh.polygons.size(), 12U);
  taut::Box box;
  for (const dvec3& p : mesh.points) box.include(p);
  EXPECT_EQ(box.lower, dvec3(0));
  EXPECT_EQ(box.upper, dvec3(1));
}

// ---------------------------------------------------------------- OBJ

TEST_F(ReadMesh, Obj) {
  std::string text = "# a comment\nmtllib a.mtl\no thing\n";
  for (const std::string line :
       {"v 0.1 0 1e-300", "v 1 0.33333333333333331 -0 1.0",
        "v 0.66666666666666663 1 5e-324 .1 .2 .3", "v 0 1 \\\n 1.7976931348623157e308"}) {
    text += line + "\r\n";
  }
  text += "vt 0 0\nvn 0 0 1\ng side\nusemtl m\nf 1/1/1 -3 3//1 4/1\nf 1 4 5\n";
  text += "v -1e22 0.5 0.30000000000000004\nl 1 2\ncstype bezier\nwhatever 1 2 3\n";
  expect_sample(read("a.obj", text));
}

TEST_F(ReadMesh, ObjMalformed) {
  EXPECT_EQ(message<IoError>("a.obj", "v 0 0\n"), ":1: v takes three coordinates");
  EXPECT_EQ(message<IoError>("a.obj", "v 0 0 0\nf 1 b 1\n"), ":2: a vertex expected, found \"b\"");
  for (const std::string word : {"1///", "1/2/3/", "1/-", "1//-/3", "1/2-"}) {
    const std::string expected = ":2: a vertex expected, found \"" + word + "\"";
    EXPECT_EQ(message<IoError>("a.obj", "v 0 0 0\nf 1/ 1// " + word + " 1\n"), expected);
  }
  EXPECT_EQ(message<InvalidInput>("a.obj", "v 0 0 inf\n"),
            ":1: a coordinate is not finite: \"inf\"");
  EXPECT_EQ(message<InvalidInput>("a.obj", "v 0 0 0\nf 1 1\n"),
            ":2: a face has fewer than three vertices");
  EXPECT_EQ(message<InvalidInput>("a.obj", "v 0 0 0\nf 1 0 1\n"),
            ":2: vertex 0 is referred to, but 1 came before");
  EXPECT_EQ(message<InvalidInput>("a.obj", "v 0 0 0\nf 1 1 -2\n"),
            ":2: vertex -2 is referred to, but 1 came before");
  EXPECT_EQ(message<InvalidInput>("a.obj", "v 0 0 0\nf 1 7 1\nf 1 1 3\n"),
            ":2: vertex 7 is referred to, but there are 1");
  EXPECT_EQ(message<InvalidInput>("a.obj", "v 0 0 0\nf 1 1 4000000000\n"),
            ":2: vertex 4000000000 is referred to, but there are 1");
}

// ---------------------------------------------------------------- OFF

TEST_F(ReadMesh, OffWaysToWriteTheSame) {
  const std::string faces = "4 0 1 2 3\n3 0 3 4\n";
  std::string with_colours = "COFF\n5 2 0\n";
  for (const char c : ascii_points) {
    if (c == '\n') with_colours += " 255 0 0 255";
    with_colours += c;
  }
  for (const std::string& text :
       {"OFF\n5 2 0\n" + ascii_points + faces, "OFF 5 2 6 " + ascii_points + faces,
        "# comment\nOFF # here\n\n5 2\n" + ascii_points + "# faces\n" + faces,
        "5 2 0\n" + ascii_points + faces, with_colours + faces,
        "OFF\r\n5 2 0\r\n" + ascii_points + "4 0 1 2 3 255 0 0\r\n3 0 3 4 1\r\nmore"}) {
    expect_sample(read("a.off", text));
  }
}

TEST_F(ReadMesh, OffMalformed) {
  EXPECT_EQ(message<IoError>("a.off", ""), ":1: the file ends where OFF is expected");
  EXPECT_EQ(message<IoError>("a.off", "OFF\n"),
            ":2: the file ends where the number of vertices is expected");
  EXPECT_EQ(message<IoError>("a.off", "GIF 1 1"),
            ":1: the number of vertices expected, found \"GIF\"");
  EXPECT_EQ(message<IoError>("a.off", "OFF BINARY\n"),
            ":1: the binary form of OFF is not supported");
  EXPECT_EQ(message<IoError>("a.off", "4OFF\n1 0 0\n0 0 0 1\n"),
            ":1: points of other than three coordinates are not supported");
  EXPECT_EQ(message<IoError>("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 zero\n3 0 1 2\n"),
            ":5: a coordinate expected, found \"zero\"");
  EXPECT_EQ(message<IoError>("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1        "),
            ":6: the file ends where a vertex index is expected");
  EXPECT_EQ(message<InvalidInput>("a.off", "OFF\n-3 1 0\n"),
            ":2: the number of vertices is negative: \"-3\"");
  EXPECT_EQ(message<InvalidInput>("a.off", "OFF\n1000000000 1 0\n0 0 0\n"),
            ":2: 1000000000 vertices announced, more than the remaining 7 bytes can hold");
  EXPECT_EQ(message<InvalidInput>("a.off", "OFF\n1 1000000000 0\n0 0 0\n"),
            ":2: 1000000000 faces announced, more than the remaining 7 bytes can hold");
  EXPECT_EQ(message<InvalidInput>("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            ":6: vertex index 3 is not below 3");
  EXPECT_EQ(message<InvalidInput>("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1    \n"),
            ":6: a face has fewer than three vertices");
  EXPECT_EQ(message<InvalidInput>("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n99 0 1 2 \n"),
            ":6: 99 vertices of a face announced, more than the remaining 8 bytes can hold");
}

TEST_F(ReadMesh, OffFromElsewhere) {
  const char* folder = std::getenv("TAUT_MODELS");
  if (folder == nullptr) GTEST_SKIP() << "TAUT_MODELS is not set";
  const std::filesystem::path path = std::filesystem::path(folder) / "A19_torus_quad_smooth.off";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const PolygonMesh mesh = taut::read_mesh(path);
  EXPECT_EQ(mesh.points.size(), 25U);
  EXPECT_EQ(mesh.polygons.size(), 25U);
  EXPECT_EQ(mesh.points[0], dvec3(0.107677, -1.54743e-018, -0.331395));
  for (const auto& polygon : mesh.polygons) EXPECT_EQ(polygon.size(), 4U);
}

// ---------------------------------------------------------------- STL

/// Two triangles that share an edge.
const std::vector<dvec3> stl_points = {{0, 0, 0}, {1, 0, 0.5}, {0, 1, 0}, {1, 1, 0.25}};
const Polygons stl_triangles = {{0, 1, 2}, {2, 1, 3}};

std::string binary_stl(const std::string& header) {
  OrderedBytes bytes;
  bytes << std::uint32_t{2};
  for (const auto& triangle : stl_triangles) {
    for (int i = 0; i < 3; ++i) bytes << std::numeric_limits<float>::quiet_NaN();
    for (const int corner : triangle) {
      const dvec3& p = stl_points[static_cast<std::size_t>(corner)];
      for (int i = 0; i < 3; ++i) bytes << static_cast<float>(p[i]);
    }
    bytes << std::uint16_t{0x8000};
  }
  std::string text = header;
  text.resize(80, ' ');
  return text + bytes.str();
}

const std::string ascii_stl =
    "solid my # part\nfacet normal nan 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 .5\n"
    "vertex 0 1 -0\nendloop\nendfacet\n  FACET NORMAL 0 0 1\n  OUTER LOOP\n  VERTEX 0 1 0\n"
    "  VERTEX 1.0 0 5e-1\n  VERTEX 1 1 0.25\n  ENDLOOP\n  ENDFACET\nendsolid my part\n";

std::string with_carriage_returns(std::string text) {
  for (std::size_t i = 0; (i = text.find('\n', i)) != text.npos; i += 2) text.insert(i, 1, '\r');
  return text;
}

TEST_F(ReadMesh, Stl) {
  for (const std::string& text :
       {binary_stl("part"), binary_stl("solid part"), binary_stl("solid part") + "more", ascii_stl,
        "\n " + ascii_stl, "\xEF\xBB\xBF" + ascii_stl, "SOLID" + ascii_stl.substr(5),
        with_carriage_returns(ascii_stl)}) {
    const PolygonMesh mesh = read("a.stl", text);
    EXPECT_EQ(mesh.points, stl_points);
    EXPECT_EQ(mesh.polygons, stl_triangles);
  }
}

TEST_F(ReadMesh, StlOfSeveralSolids) {
  const PolygonMesh mesh = read("a.stl", ascii_stl + ascii_stl);
  EXPECT_EQ(mesh.points, stl_points);
  EXPECT_EQ(mesh.polygons.size(), 4U);
}

TEST_F(ReadMesh, StlMalformed) {
  EXPECT_EQ(message<IoError>("a.stl", ""), ":byte 0: the file ends early");
  EXPECT_EQ(message<IoError>("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 b\n"),
            ":4: a coordinate expected, found \"b\"");
  EXPECT_EQ(message<IoError>("a.stl", "solid\nfacet normal 0 0 1\nloop\n"),
            ":3: outer expected, found \"loop\"");
  EXPECT_EQ(message<IoError>("a.stl", "solid\nface\n"),
            ":2: facet or endsolid expected, found \"face\"");
  EXPECT_EQ(message<IoError>("a.stl", "solid\n"), ":2: the file ends where endsolid is expected");
  EXPECT_EQ(
      message<InvalidInput>("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 -inf\n"),
      ":4: a coordinate is not finite: \"-inf\"");
  const std::string good = binary_stl("part");
  EXPECT_EQ(message<InvalidInput>("a.stl", good.substr(0, good.size() - 1)),
            ":byte 80: 2 triangles announced, more than the remaining 99 bytes can hold");
  EXPECT_EQ(
      message<InvalidInput>(
          "a.stl", std::string(80, ' ') + (OrderedBytes() << std::uint32_t{4294967295U}).str()),
      ":byte 80: 4294967295 triangles announced, more than the remaining 0 bytes can hold");
  // "solid" alone does not make it text.
  const std::string solid = binary_stl("solid part");
  EXPECT_EQ(message<InvalidInput>("a.stl", solid.substr(0, solid.size() - 1)),
            ":byte 80: 2 triangles announced, more than the remaining 99 bytes can hold");
  std::string nan = good;
  nan.replace(84 + 12 + 4, 4, (OrderedBytes() << std::numeric_limits<float>::quiet_NaN()).str());
  EXPECT_EQ(message<InvalidInput>("a.stl", nan),
            ":byte 100: a coordinate of triangle 0 is not finite");
}

// ---------------------------------------------------------------- any

TEST_F(ReadMesh, FromMemory) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(taut::read_mesh(obj, "standard input", ".obj").polygons, (Polygons{{0, 1, 2}}));
  EXPECT_EQ(taut::read_mesh(binary_stl("part"), "-", ".stl").points, stl_points);
  expect_sample(taut::read_mesh(binary_ply(true), "-", ".ply"));
  EXPECT_EQ(message_of<IoError>([&] { taut::read_mesh("v 0 0\n", "standard input", ".obj"); }),
            "standard input:1: v takes three coordinates");
  EXPECT_EQ(message_of<IoError>([&] { taut::read_mesh(obj, "-", ".xyz"); }),
            "-: no format of meshes has the extension \".xyz\"; known are .obj, .off, .ply, .stl");
}

TEST_F(ReadMesh, UnknownExtension) {
  EXPECT_EQ(message<IoError>("a.step", ""),
            ": no format of meshes has the extension \".step\"; known are .obj, .off, .ply, .stl");
}

/// Whatever is done to a file, it is read as promised or refused with a promised error.
void expect_mesh_or_refused(const std::filesystem::path& path) {
  try {
    const PolygonMesh mesh = taut::read_mesh(path);
    for (const dvec3& p : mesh.points) {
      EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
    for (const auto& polygon : mesh.polygons) {
      EXPECT_GE(polygon.size(), 3U);
      for (const int i : polygon) {
        EXPECT_TRUE(0 <= i && static_cast<std::size_t>(i) < mesh.points.size());
      }
    }
  } catch (const taut::Error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(path.string())) << error.what();
  }
}

TEST_F(ReadMesh, DamagedFiles) {
  std::mt19937 random(3);
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"a.ply", binary_ply(false)},
           {"a.ply", binary_ply(true)},
           {"a.ply", "ply\nformat ascii 1.0\n" + ply_vertices + ply_faces + "end_header\n" +
                         ascii_points + "4 0 1 2 3\n3 0 3 4\n"},
           {"a.off", "OFF\n5 2 0\n" + ascii_points + "4 0 1 2 3\n3 0 3 4\n"},
           {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 -2//3 3\n"},
           {"a.stl", binary_stl("part")},
           {"a.stl", ascii_stl}}) {
    for (std::size_t length = 0; length < text.size(); ++length) {
      expect_mesh_or_refused(file(name, text.substr(0, length)));
    }
    for (int k = 0; k < 1000; ++k) {
      std::string damaged = text;
      for (int n = 0; n <= k % 4; ++n) {
        damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
      }
      expect_mesh_or_refused(file(name, damaged));
    }
  }
}

}  // namespace
