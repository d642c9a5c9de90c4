#include "taut/io/model/read_project.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <utility>
#include <vector>

#include "taut/io/model/affine_map.h"
#include "taut/io/model/read_part.h"
#include "taut/io/text/formats.h"
#include "taut/io/text/text_scanner.h"

namespace taut {
namespace {

/// Far above every project; a document takes many times the memory of its text.
constexpr std::size_t max_project_bytes = std::size_t{1} << 26;

/// The first layers of a project that is all invisible are enough.
constexpr int most_invisible_warnings = 20;

/// Most control points, corners and points of files that are repeated under maps which are not
/// rigid: a few bytes name a file again, and each becomes a part.
constexpr std::size_t max_repeated_points = std::size_t{1} << 26;

/// Of a file's name in messages.
constexpr std::size_t longest_path = 4096;

struct ProjectLayer {
  std::string file;
  std::string label;
  AffineMap map;
  long line = 0;
};

/// Turns the document into layers.
class ProjectParser {
 public:
  ProjectParser(const std::string& file, std::string_view data, const Progress& progress)
      : scanner_(file, data), file_(file), data_(data), progress_(progress) {}

  std::vector<ProjectLayer> parse();

 private:
  long line_at(std::ptrdiff_t offset);
  void read_group(const pugi::xml_node& group);
  void read_layer(const pugi::xml_node& node);
  AffineMap read_matrix(const pugi::xml_node& node);
  void warn(long line, std::string_view code, const std::string& what) const {
    progress_.warning(code, file_ + ":" + std::to_string(line) + ": " + what);
  }

  TextScanner scanner_;
  const std::string& file_;
  std::string_view data_;
  const Progress& progress_;
  std::vector<ProjectLayer> layers_;
  int invisible_ = 0;
  bool has_rasters_ = false;
  // Where line_at() was asked last.
  std::ptrdiff_t offset_ = 0;
  long line_ = 1;
};

std::vector<ProjectLayer> ProjectParser::parse() {
  if (data_.size() > max_project_bytes) {
    throw LimitExceeded(file_ + ": is larger than " + std::to_string(max_project_bytes >> 20) +
                        " MiB, the most that a project may have");
  }
  pugi::xml_document document;
  const pugi::xml_parse_result result =
      document.load_buffer(data_.data(), data_.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result)
    scanner_.fail(line_at(result.offset), std::string("is no XML: ") + result.description());
  const pugi::xml_node root = document.document_element();
  const long line = line_at(root.offset_debug());
  if (std::string_view(root.name()) != "MeshLabProject") {
    scanner_.fail(line, "MeshLabProject expected, found " + in_quotes(root.name()));
  }
  for (const pugi::xml_node& child : root.children()) {
    if (std::string_view(child.name()) == "MeshGroup") read_group(child);
    if (std::string_view(child.name()) == "RasterGroup" && child.child("MLRaster") &&
        !std::exchange(has_rasters_, true)) {
      warn(line_at(child.offset_debug()), "raster-layer", "rasters are left out");
    }
  }
  if (layers_.empty()) {
    scanner_.refuse(line, std::string("the project has no layers") +
                              (invisible_ > 0 ? " that are visible" : ""));
  }
  return std::move(layers_);
}

/// Counts on from the last offset, since nodes are met in the order of the file.
long ProjectParser::line_at(std::ptrdiff_t offset) {
  const std::ptrdiff_t end =
      std::clamp(offset, std::ptrdiff_t{0}, static_cast<std::ptrdiff_t>(data_.size()));
  if (end < offset_) {
    offset_ = 0;
    line_ = 1;
  }
  line_ += std::count(data_.begin() + offset_, data_.begin() + end, '\n');
  offset_ = end;
  return line_;
}

void ProjectParser::read_group(const pugi::xml_node& group) {
  for (const pugi::xml_node& node : group.children("MLMesh")) {
    const std::string_view visible = node.attribute("visible").value();
    if (visible == "0" || visible == "false") {
      if (++invisible_ > most_invisible_warnings) continue;
      warn(line_at(node.offset_debug()), "invisible-layer",
           "layer " + in_quotes(node.attribute("label").value()) + " is not visible and left out");
    } else {
      read_layer(node);
    }
  }
}

void ProjectParser::read_layer(const pugi::xml_node& node) {
  ProjectLayer layer;
  layer.line = line_at(node.offset_debug());
  layer.file = node.attribute("filename").value();
  layer.label = node.attribute("label").value();
  if (layer.file.empty()) scanner_.fail(layer.line, "a layer has no filename");
  if (layer.label.empty()) layer.label = layer.file;
  // MeshLab numbers the layers of formats that hold several; -1 is what it writes for all others.
  const std::string_view in_file = node.attribute("idInFile").value();
  if (!in_file.empty() && in_file != "-1" && in_file != "0") {
    scanner_.fail(layer.line, "layer " + in_quotes(layer.label) + ": idInFile " +
                                  in_quotes(in_file) + " where files hold one layer");
  }
  if (const pugi::xml_node matrix = node.child("MLMatrix44")) layer.map = read_matrix(matrix);
  layers_.push_back(std::move(layer));
}

AffineMap ProjectParser::read_matrix(const pugi::xml_node& node) {
  const long line = line_at(node.offset_debug());
  const std::string_view text = node.child_value();
  TextScanner words(file_, text);
  double m[4][4];
  for (int i = 0; i < 16; ++i) {
    if (words.at_end()) {
      scanner_.fail(line, "MLMatrix44 has " + std::to_string(i) + " numbers, not 16");
    }
    m[i / 4][i % 4] =
        scanner_.number({words.next("a number").text, line + words.line() - 1}, "a number");
  }
  if (!words.at_end()) scanner_.fail(line, "MLMatrix44 has more than 16 numbers");
  if (m[3][0] != 0 || m[3][1] != 0 || m[3][2] != 0 || m[3][3] != 1) {
    scanner_.refuse(line, "the last row of MLMatrix44 is not 0 0 0 1");
  }
  AffineMap map;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) map.linear[column][row] = m[row][column];
    map.translation[row] = m[row][3];
  }
  if (is_singular(map)) scanner_.refuse(line, "MLMatrix44 is singular");
  return map;
}

/// Its control points, corners and points.
std::size_t size_of(const Part& part) {
  std::size_t size = part.vertices().size();
  for (const std::vector<int>& polygon : part.polygons()) size += polygon.size();
  for (const Patch& patch : part.patches()) size += patch.bezier.points.size();
  for (const EdgePiece& piece : part.pieces()) size += piece.bezier.points.size();
  return size;
}

/// Reads the files of the layers and puts the parts into a model.
class ProjectLoader {
 public:
  ProjectLoader(const std::string& file, const ReadOptions& options)
      : file_(file), options_(options) {}

  void add(const ProjectLayer& layer);
  void put_into(Model& model);

 private:
  /// A file, and the part that its instances are of, if there are any yet.
  struct File {
    Part part;
    std::optional<std::size_t> slot;
    bool used = false;
  };

  File& file(const std::filesystem::path& path);
  void add_placed(const ProjectLayer& layer);

  const std::string& file_;
  const ReadOptions& options_;
  std::map<std::string, File> files_;
  std::deque<Part> images_;
  std::size_t repeated_points_ = 0;
  std::vector<Part*> parts_;
  std::vector<Instance> instances_;
};

void ProjectLoader::add(const ProjectLayer& layer) {
  const auto place = [&](const Error& error) {
    return file_ + ":" + std::to_string(layer.line) + ": layer " + in_quotes(layer.label) + ": " +
           error.what();
  };
  try {
    add_placed(layer);
  } catch (const IoError& error) {
    throw IoError(place(error));
  } catch (const InvalidInput& error) {
    throw InvalidInput(place(error));
  } catch (const LimitExceeded& error) {
    throw LimitExceeded(place(error));
  }
}

void ProjectLoader::add_placed(const ProjectLayer& layer) {
  File& source = file(std::filesystem::path(file_).parent_path() / layer.file);
  if (!is_rigid(layer.map)) {
    if (std::exchange(source.used, true)) repeated_points_ += size_of(source.part);
    if (repeated_points_ > max_repeated_points) {
      throw LimitExceeded(
          "files that are repeated under matrices which are not rigid have more than " +
          std::to_string(max_repeated_points) + " control points");
    }
    images_.push_back(transformed(source.part, layer.map));
    instances_.push_back({static_cast<int>(parts_.size()), {}});
    parts_.push_back(&images_.back());
    return;
  }
  source.used = true;
  if (!source.slot) {
    source.slot = parts_.size();
    parts_.push_back(&source.part);
  }
  instances_.push_back({static_cast<int>(*source.slot), {layer.map.linear, layer.map.translation}});
}

/// The file, read if it was not yet.
ProjectLoader::File& ProjectLoader::file(const std::filesystem::path& path) {
  const std::string key = path.lexically_normal().string();
  const auto known = files_.find(key);
  if (known != files_.end()) return known->second;
  const std::string name = printable(path.string(), longest_path);
  const std::string format = input_extension(path);
  if (name != path.string()) {
    throw IoError(name + ": the name has control characters or is too long");
  }
  if (format == ".mlp") throw IoError(name + ": a project within a project is not read");
  if (!is_part_format(format)) {
    throw IoError(name + ": no format of layers has the extension " + in_quotes(format));
  }
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    throw IoError(name + ": is no file");
  }
  FileContent content = read_content(read_file(path, options_.progress), name, format, options_);
  return files_.emplace(key, File{as_part(std::move(content), name, options_), {}, false})
      .first->second;
}

void ProjectLoader::put_into(Model& model) {
  for (Part* part : parts_) {
    options_.progress.check();
    part->connect(options_.smooth_angle, options_.progress);
  }
  Model grown = model;
  std::vector<Instance> all = model.instances();
  const int first = static_cast<int>(model.parts().size());
  for (const Instance& instance : instances_) {
    all.push_back({first + instance.part, instance.pose});
  }
  try {
    for (Part* part : parts_) {
      grown.add_part(std::move(*part), options_.smooth_angle, options_.progress);
      // It comes with an instance at rest, which need not be one of the project's.
      grown.clear_instances();
    }
    for (const Instance& instance : all) grown.add_instance(instance.part, instance.pose);
  } catch (const InvalidInput& error) {
    throw InvalidInput(file_ + ": " + error.what());
  } catch (const LimitExceeded& error) {
    throw LimitExceeded(file_ + ": " + error.what());
  }
  model = std::move(grown);
}

}  // namespace

void read_project(const std::string& file, std::string_view data, Model& model,
                  const ReadOptions& options) {
  const std::vector<ProjectLayer> layers = ProjectParser(file, data, options.progress).parse();
  ProjectLoader loader(file, options);
  for (const ProjectLayer& layer : layers) loader.add(layer);
  loader.put_into(model);
}

}  // namespace taut
