#include "taut/io/obj/obj_file.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "taut/core/tolerances.h"
#include "taut/io/mesh/obj_reference.h"

namespace taut {
namespace {

using Statement = std::vector<Word>;

/// Statements that change nothing of the geometry: materials, rendering, normals, texture, and the
/// joins of surfaces, which are found from their borders.
bool is_silent(std::string_view keyword) {
  static const std::set<std::string_view> silent = {
      "bevel",     "bmat",   "c_interp", "con", "ctech", "d_interp",   "lod",
      "maplib",    "mg",     "mtllib",   "s",   "step",  "shadow_obj", "stech",
      "trace_obj", "usemap", "usemtl",   "vn",  "vt"};
  return silent.contains(keyword);
}

class Parser {
 public:
  Parser(TextScanner& scanner, const Progress& progress)
      : scanner_(scanner), progress_(progress), bytes_(scanner.bytes_left()) {}

  ObjFile parse();

 private:
  void dispatch(const Statement& s);
  void read_vertex(const Statement& s);
  void read_parameter_point(const Statement& s);
  void read_polygon(const Statement& s);
  void read_points(const Statement& s);
  void read_polyline(const Statement& s);
  void read_tag(const Statement& s);
  void read_name(const Statement& s);
  void read_type(const Statement& s);
  void read_degree(const Statement& s);
  void begin_element(const Statement& s);
  void begin_parameter_curve(const Statement& s);
  void begin_body(const Statement& s);
  void read_parameters(const Statement& s);
  void read_loop(const Statement& s);
  void pass_special_geometry(const Statement& s);
  void end_element(const Statement& s);

  void require_no_body(const Statement& s) const;
  void require_body(const Statement& s) const;
  Interval read_range(const Statement& s, std::size_t first) const;
  void warn_once(std::string_view code, const Word& keyword, const std::string& what);

  TextScanner& scanner_;
  const Progress& progress_;
  std::size_t bytes_;
  ObjFile file_;
  ObjReferences references_;
  ObjTagReader tags_;

  // The state that elements stand in.
  std::string name_;
  std::string type_;
  bool rational_ = false;
  int degree_u_ = 0;
  int degree_v_ = 0;

  // The element between its statement and `end`.
  std::string body_;
  ObjElement element_;

  std::set<std::string, std::less<>> warned_;
};

ObjFile Parser::parse() {
  constexpr std::size_t statements_per_update = 4096;
  Statement statement;
  for (std::size_t i = 0; scanner_.next_statement(statement); ++i) {
    if (i % statements_per_update == 0) {
      const double left = static_cast<double>(scanner_.bytes_left());
      progress_.update("read", 1 - left / static_cast<double>(bytes_));
    }
    dispatch(statement);
  }
  if (!body_.empty()) {
    scanner_.fail(element_.line, "the " + body_ + " that begins here has no end");
  }
  references_.check(scanner_, file_.vertices.size());
  tags_.check(scanner_, file_.vertices.size(), file_.polygons.size());
  file_.tags = tags_.take();
  return std::move(file_);
}

void Parser::dispatch(const Statement& s) {
  static const std::map<std::string_view, void (Parser::*)(const Statement&)> readers = {
      {"v", &Parser::read_vertex},
      {"vp", &Parser::read_parameter_point},
      {"f", &Parser::read_polygon},
      {"fo", &Parser::read_polygon},
      {"p", &Parser::read_points},
      {"l", &Parser::read_polyline},
      {"t", &Parser::read_tag},
      {"g", &Parser::read_name},
      {"o", &Parser::read_name},
      {"cstype", &Parser::read_type},
      {"deg", &Parser::read_degree},
      {"curv", &Parser::begin_element},
      {"surf", &Parser::begin_element},
      {"curv2", &Parser::begin_parameter_curve},
      {"parm", &Parser::read_parameters},
      {"trim", &Parser::read_loop},
      {"hole", &Parser::read_loop},
      {"scrv", &Parser::pass_special_geometry},
      {"sp", &Parser::pass_special_geometry},
      {"end", &Parser::end_element},
  };
  const auto reader = readers.find(s[0].text);
  if (reader != readers.end()) {
    (this->*reader->second)(s);
  } else if (!is_silent(s[0].text)) {
    warn_once("unknown-statement", s[0], "is not known and left out");
  }
}

void Parser::read_parameter_point(const Statement& s) {
  if (s.size() < 2) scanner_.fail(s[0].line, "vp takes a parameter or more");
  ObjVertex point;
  point.point = {scanner_.number(s[1], "a parameter"),
                 s.size() > 2 ? scanner_.number(s[2], "a parameter") : 0, 0};
  if (s.size() > 3) point.weight = scanner_.number(s[3], "a weight");
  point.line = s[0].line;
  file_.parameter_points.push_back(point);
}

void Parser::read_polygon(const Statement& s) {
  add_obj_polygon(scanner_, s, file_.vertices.size(), references_, file_.polygons);
}

void Parser::read_points(const Statement& s) {
  if (s.size() < 2) scanner_.fail(s[0].line, "p takes a vertex or more");
  for (std::size_t i = 1; i < s.size(); ++i) {
    file_.points.push_back(references_.add(scanner_, s[i], file_.vertices.size()));
  }
}

void Parser::read_polyline(const Statement& s) {
  if (s.size() < 3) scanner_.refuse(s[0].line, "a line has fewer than two vertices");
  ObjElement line;
  line.line = line.parameters_line_u = s[0].line;
  line.spline = true;
  line.degree_u = 1;
  line.name = name_;
  line.parameters_u.push_back(0);
  for (std::size_t i = 1; i < s.size(); ++i) {
    line.vertices.push_back(obj_index(scanner_, s[i], file_.vertices.size()));
    line.parameters_u.push_back(static_cast<double>(i - 1));
  }
  line.u = {0, line.parameters_u.back()};
  line.parameters_u.push_back(line.u.upper);
  file_.elements.push_back(std::move(line));
}

void Parser::read_tag(const Statement& s) {
  if (file_.tag_line == 0) file_.tag_line = s[0].line;
  if (!tags_.add(scanner_, s)) warn_once("unknown-tag", s[1], "is a tag that is left out");
}

void Parser::read_loop(const Statement& s) {
  require_body(s);
  const std::string keyword(s[0].text);
  if (body_ != "surf") scanner_.fail(s[0].line, "a curve has no " + keyword);
  if (s.size() < 4 || (s.size() - 1) % 3 != 0) {
    scanner_.fail(s[0].line, keyword + " takes a range and a curv2, once or several times");
  }
  ObjLoop& loop = element_.loops.emplace_back();
  loop.hole = keyword == "hole";
  loop.line = s[0].line;
  for (std::size_t i = 1; i < s.size(); i += 3) {
    const Interval range = read_range(s, i);
    loop.curves.push_back(
        {earlier_obj_index(scanner_, s[i + 2], file_.parameter_curves.size(), "a curv2"), range});
  }
}

void Parser::pass_special_geometry(const Statement& s) {
  require_body(s);
  warn_once("special-geometry", s[0], "special curves and points are left out");
}

void Parser::read_vertex(const Statement& s) {
  ObjVertex vertex;
  vertex.point = obj_point(scanner_, s);
  // Six numbers are a point and a colour, as some programs write; seven have the weight as well.
  if (s.size() == 5 || s.size() == 8) vertex.weight = scanner_.number(s[4], "a weight");
  vertex.line = s[0].line;
  file_.vertices.push_back(vertex);
}

void Parser::read_name(const Statement& s) {
  name_.clear();
  for (std::size_t i = 1; i < s.size(); ++i) {
    if (i > 1) name_ += ' ';
    name_ += s[i].text;
  }
}

void Parser::read_type(const Statement& s) {
  require_no_body(s);
  rational_ = s.size() == 3 && s[1].text == "rat";
  if (s.size() != (rational_ ? 3U : 2U)) {
    scanner_.fail(s[0].line, "cstype takes a type, perhaps after the word rat");
  }
  type_ = s.back().text;
  if (type_ == "bmatrix" || type_ == "cardinal" || type_ == "taylor") {
    scanner_.fail(s[0].line, "cstype " + type_ + " is not supported; bezier and bspline are");
  }
  if (type_ != "bezier" && type_ != "bspline") {
    scanner_.fail(s[0].line, "bezier or bspline expected, found " + in_quotes(type_));
  }
}

void Parser::read_degree(const Statement& s) {
  require_no_body(s);
  if (s.size() != 2 && s.size() != 3) scanner_.fail(s[0].line, "deg takes one or two degrees");
  int degrees[2] = {0, 0};
  for (std::size_t i = 1; i < s.size(); ++i) {
    const long degree = scanner_.integer(s[i], "a degree");
    if (degree < 1 || degree > max_degree) {
      scanner_.refuse(s[i].line, "degree " + std::to_string(degree) + " is not in 1 .. " +
                                     std::to_string(max_degree));
    }
    degrees[i - 1] = static_cast<int>(degree);
  }
  degree_u_ = degrees[0];
  degree_v_ = degrees[1];
}

/// What the statements that a body may follow have in common.
void Parser::begin_body(const Statement& s) {
  require_no_body(s);
  body_ = s[0].text;
  if (type_.empty()) scanner_.fail(s[0].line, body_ + " stands before any cstype");
  if (degree_u_ == 0) scanner_.fail(s[0].line, body_ + " stands before any deg");
  element_ = {};
  element_.line = s[0].line;
  element_.rational = rational_;
  element_.spline = type_ == "bspline";
  element_.degree_u = degree_u_;
  element_.degree_v = degree_v_;
  element_.name = name_;
}

void Parser::begin_element(const Statement& s) {
  begin_body(s);
  element_.surface = body_ == "surf";
  if (element_.surface && degree_v_ == 0) {
    scanner_.fail(s[0].line, "surf needs two degrees, the last deg gives one");
  }
  const std::size_t first_vertex = element_.surface ? 5 : 3;
  if (s.size() <= first_vertex) {
    scanner_.fail(s[0].line, element_.surface ? "surf takes s0 s1 t0 t1 and vertices"
                                              : "curv takes t0 t1 and vertices");
  }
  element_.u = read_range(s, 1);
  if (element_.surface) element_.v = read_range(s, 3);
  element_.vertices.reserve(s.size() - first_vertex);
  for (std::size_t i = first_vertex; i < s.size(); ++i) {
    element_.vertices.push_back(obj_index(scanner_, s[i], file_.vertices.size()));
  }
}

void Parser::begin_parameter_curve(const Statement& s) {
  begin_body(s);
  if (s.size() < 3) scanner_.fail(s[0].line, "curv2 takes two parameter points or more");
  for (std::size_t i = 1; i < s.size(); ++i) {
    element_.vertices.push_back(
        earlier_obj_index(scanner_, s[i], file_.parameter_points.size(), "a parameter point"));
  }
}

void Parser::read_parameters(const Statement& s) {
  require_body(s);
  const bool is_u = s.size() > 1 && s[1].text == "u";
  if (s.size() < 4 || (!is_u && s[1].text != "v")) {
    scanner_.fail(s[0].line, "parm takes u or v and two parameters or more");
  }
  if (!is_u && body_ != "surf") scanner_.fail(s[0].line, "a curve has no parm v");
  std::vector<double>& parameters = is_u ? element_.parameters_u : element_.parameters_v;
  if (!parameters.empty()) {
    scanner_.fail(s[0].line, "parm " + std::string(s[1].text) + " stands here a second time");
  }
  (is_u ? element_.parameters_line_u : element_.parameters_line_v) = s[0].line;
  for (std::size_t i = 2; i < s.size(); ++i) {
    parameters.push_back(scanner_.number(s[i], "a parameter"));
    if (i > 2 && parameters[i - 2] < parameters[i - 3]) {
      scanner_.refuse(s[i].line,
                      "parameter " + in_quotes(s[i].text) + " is below the one before it");
    }
  }
}

void Parser::end_element(const Statement& s) {
  require_body(s);
  (body_ == "curv2" ? file_.parameter_curves : file_.elements).push_back(std::move(element_));
  body_.clear();
}

void Parser::require_no_body(const Statement& s) const {
  if (body_.empty()) return;
  scanner_.fail(s[0].line, std::string(s[0].text) + " stands before the end of the " + body_ +
                               " of line " + std::to_string(element_.line));
}

void Parser::require_body(const Statement& s) const {
  if (body_.empty())
    scanner_.fail(s[0].line, std::string(s[0].text) + " stands in no curv or surf");
}

Interval Parser::read_range(const Statement& s, std::size_t first) const {
  const Interval range = {scanner_.number(s[first], "a parameter"),
                          scanner_.number(s[first + 1], "a parameter")};
  if (!(range.lower < range.upper)) {
    scanner_.refuse(s[first].line, "the range of parameters is empty: " + in_quotes(s[first].text) +
                                       " to " + in_quotes(s[first + 1].text));
  }
  return range;
}

void Parser::warn_once(std::string_view code, const Word& keyword, const std::string& what) {
  // What is no OBJ file at all could name any number of statements.
  constexpr std::size_t most_kinds = 20;
  if (warned_.size() >= most_kinds || !warned_.emplace(keyword.text).second) return;
  progress_.warning(code, scanner_.file() + ":" + std::to_string(keyword.line) + ": " +
                              in_quotes(keyword.text) + ": " + what);
}

}  // namespace

ObjFile parse_obj(TextScanner& scanner, const Progress& progress) {
  return Parser(scanner, progress).parse();
}

}  // namespace taut
