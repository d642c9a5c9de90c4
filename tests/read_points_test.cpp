// Reader of points, .xyz.

#include <algorithm>
#include <clocale>
#include <cmath>
#include <locale>
#include <random>
#include <stop_token>
#include <vector>

#include "taut/io/model/read_model.h"
#include "taut/io/text/text_scanner.h"
#include "temporary_folder.h"

namespace {

using taut::dvec3;
using taut::InvalidInput;
using taut::IoError;
using taut::Model;
using taut_test::message_of;

using Points = std::vector<dvec3>;

Points read(std::string_view text) {
  Model model;
  taut::read_model(text, "a.xyz", ".xyz", model);
  EXPECT_EQ(model.parts().size(), 1U);
  EXPECT_TRUE(model.parts()[0].polygons().empty());
  return model.parts()[0].vertices();
}

/// The message after "a.xyz".
template <class Error>
std::string message(std::string_view text) {
  const std::string what = message_of<Error>([&] { read(text); });
  EXPECT_TRUE(what.starts_with("a.xyz")) << what;
  EXPECT_EQ(what.find('\n'), what.npos) << what;
  return what.substr(std::min<std::size_t>(5, what.size()));
}

struct MalformedPoints {
  std::string text;
  std::string message;
};

const Points two_points = {{0.1, -2, 1e-300}, {1.0 / 3, 0.30000000000000004, -1e22}};

using ReadPoints = taut_test::TemporaryFolder;

TEST_F(ReadPoints, WaysToWriteTheSame) {
  for (const std::string text :
       {"0.1 -2 1e-300\n0.33333333333333331 0.30000000000000004 -1e22\n",
        "0.1 -2 1e-300\n0.33333333333333331 0.30000000000000004 -1e22",
        "0.1 -2 1e-300\r\n0.33333333333333331 0.30000000000000004 -1e22\r\n",
        "0.1 -2 1e-300\r0.33333333333333331 0.30000000000000004 -1e22\r",
        "\xEF\xBB\xBF# x y z\n\n \t\n.1\t-2.\t1E-300 # first\n"
        "  0.33333333333333331  +.30000000000000004\t -1e+22  \n#end",
        "0.1,-2,1e-300\n0.33333333333333331 , 0.30000000000000004,\t-1e22,\n",
        "0.1;-2;1e-300;\n0.33333333333333331; 0.30000000000000004 ;-1e22\n",
        "0.1,-2,1e-300\n0.33333333333333331;0.30000000000000004;-1e22\n",
        "0.1 -2 1e-300 0 0 1 255 1,5\n0.33333333333333331 0.30000000000000004 -1e22 nan label\n",
        "0.1,-2,1e-300,0,0,1,red\n0.33333333333333331,0.30000000000000004,-1e22,,,\n",
        "2\n0.1 -2 1e-300\n0.33333333333333331 0.30000000000000004 -1e22\n",
        "# points\n 2 # two\n\n0.1 -2 1e-300\n0.33333333333333331 0.30000000000000004 -1e22\n\n"}) {
    EXPECT_EQ(read(text), two_points) << text;
  }
}

TEST_F(ReadPoints, FromAFile) {
  Model model;
  taut::read_model(file("cloud.XYZ", "1 2 3\n4 5 6\n"), model);
  EXPECT_EQ(model.parts()[0].name, "cloud.XYZ");
  EXPECT_EQ(model.parts()[0].vertices(), (Points{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(model.vertex_count(), 2);
  EXPECT_TRUE(model.polyhedral());
}

TEST_F(ReadPoints, AreAllKeptInTheirOrder) {
  EXPECT_EQ(read("1 1 1\n0 0 0\n1 1 1\n"), (Points{{1, 1, 1}, {0, 0, 0}, {1, 1, 1}}));
}

TEST_F(ReadPoints, TooSmallNumbersAreZero) {
  EXPECT_EQ(read("1e-400 -1e-400 5e-324\n"), (Points{{0, -0.0, 5e-324}}));
}

TEST_F(ReadPoints, DoNotFollowTheLocale) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
  // Not installed everywhere; where it is not, this changes nothing.
  std::setlocale(LC_NUMERIC, "de_DE.UTF-8");
  const Points points = read("0.1 0.25 1.5\n");
  std::setlocale(LC_NUMERIC, "C");
  std::locale::global(before);
  EXPECT_EQ(points, (Points{{0.1, 0.25, 1.5}}));
}

TEST_F(ReadPoints, RandomDoublesComeBack) {
  std::mt19937_64 random(4);
  Points points;
  std::string text;
  for (int i = 0; i < 2000; ++i) {
    dvec3 p;
    for (int k = 0; k < 3; ++k) {
      const double exponent = std::uniform_real_distribution(-300.0, 150.0)(random);
      p[k] = (random() % 2 == 0 ? 1 : -1) * std::pow(10.0, exponent);
      text += taut::shortest(p[k]) + (k < 2 ? " " : "\n");
    }
    points.push_back(p);
  }
  EXPECT_EQ(read(text), points);
}

TEST_F(ReadPoints, ThatAreNotTheirFormat) {
  const std::string separators =
      "columns stand apart in more than one way; decimal commas are not read";
  for (const auto& [text, expected] : std::vector<MalformedPoints>{
           {"1 2\n", ":1: three coordinates expected, found 2"},
           {"1 2 # 3\n", ":1: three coordinates expected, found 2"},
           {"\n1 2 3\n4\n", ":3: three coordinates expected, found 1"},
           {"a b c\n", ":1: a coordinate expected, found \"a\""},
           {"1 2 3\r\n4 5 six\r\n", ":2: a coordinate expected, found \"six\""},
           {"1 2 3\r4 5 0x6\r", ":2: a coordinate expected, found \"0x6\""},
           {"1 2 3#\n", ":1: a coordinate expected, found \"3#\""},
           {"1,,3\n", ":1: a coordinate expected, found \"\""},
           {",1,2\n", ":1: a coordinate expected, found \"\""},
           {"1 2 3e\n", ":1: a coordinate expected, found \"3e\""},
           {std::string("1 2 \0\n", 6), ":1: a coordinate expected, found \"?\""},
           {"1,5 2,5 3,5\n", ":1: " + separators},
           {"1,5;2,5;3,5\n", ":1: " + separators},
           {"1 2 3,5\n", ":1: " + separators},
           {"2.0\n1 2 3\n4 5 6\n", ":1: the number of points expected, found \"2.0\""},
           {"2\n1 2 3 # one\n", ":3: the file ends after 1 of the 2 points that line 1 announces"},
           {"\n1\n1 2 3\n4 5 6\n", ":4: more follows the last of the 1 points that were announced"},
           {"0\n1 2 3\n", ":2: more follows the last of the 0 points that were announced"},
           {"2\nwater\nO 0 0 0\nH 0 0 1\n",
            ":2: a coordinate expected, found \"water\"; files of molecules are not read"},
           {"2\n\nO 0 0 0\nH 0 0 1\n",
            ":3: a coordinate expected, found \"O\"; files of molecules are not read"}}) {
    EXPECT_EQ(message<IoError>(text), expected) << text;
  }
}

TEST_F(ReadPoints, ThatAreNoGeometry) {
  for (const auto& [text, expected] : std::vector<MalformedPoints>{
           {"", ": holds no geometry"},
           {"# only\n\n", ": holds no geometry"},
           {"1 2 3\n1 nan 3\n", ":2: a coordinate is not finite: \"nan\""},
           {"1 2 -inf\n", ":1: a coordinate is not finite: \"-inf\""},
           {"1 2 1.#QNAN\n", ":1: a coordinate is not finite: \"1.#QNAN\""},
           {"1 2 1e999\n", ":1: a coordinate is too large: \"1e999\""},
           {"-2\n1 2 3\n", ":1: the number of points is negative: \"-2\""},
           {"1000000000\n1 2 3\n",
            ":1: 1000000000 points announced, more than the remaining 7 bytes can hold"},
           {"99999999999999999999\n1 2 3\n",
            ":1: the number of points is out of range: \"99999999999999999999\""},
           {"-1e308 0 0\n1e308 0 0\n", ": point 0: the extent overflows"}}) {
    EXPECT_EQ(message<InvalidInput>(text), expected) << text;
  }
}

TEST_F(ReadPoints, StopsWhenAsked) {
  std::stop_source stop;
  stop.request_stop();
  taut::ReadOptions options;
  options.progress.stop = stop.get_token();
  Model model;
  EXPECT_THROW(taut::read_model("1 2 3", "a.xyz", ".xyz", model, options), taut::Cancelled);
}

/// Whatever is done to a file, it is read or refused with one of the errors that are promised.
void expect_read_or_refused(const std::string& text) {
  Model model;
  try {
    taut::read_model(text, "a.xyz", ".xyz", model);
    EXPECT_FALSE(model.empty());
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("a.xyz:")) << error.what();
  } catch (const IoError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("a.xyz:")) << error.what();
  }
}

TEST_F(ReadPoints, DamagedFiles) {
  const std::string bytes = std::string("0123456789-+.,;eE#\n\r \tnainf") + '\0' + '\xff';
  std::mt19937 random(5);
  for (const std::string text : {"3\n0.1 -2 1e-3\n+3,4,5\r\n6 7 8 9\n", "1;2;3\n4 5 6 # 7\n"}) {
    for (std::size_t length = 0; length <= text.size(); ++length) {
      expect_read_or_refused(text.substr(0, length));
    }
    for (int k = 0; k < 5000; ++k) {
      std::string damaged = text;
      for (int n = 0; n <= k % 4; ++n)
        damaged[random() % damaged.size()] = bytes[random() % bytes.size()];
      expect_read_or_refused(damaged);
    }
  }
}

}  // namespace
