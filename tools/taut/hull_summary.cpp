#include "hull_summary.h"

#include <array>

#include "text.h"

namespace taut::tool {
namespace {

std::string line(const char* name, const std::string& text) {
  constexpr std::size_t width = 10;
  const std::string column = padded(name, width);
  return column + (column.back() == ' ' ? "" : " ") + one_line(text) + "\n";
}

/// What was read: "32 faces, 32 patches", "4 curves", "16 points".
std::string contents_text(const Report::Input& input) {
  std::vector<std::string> words;
  const auto add = [&](int count, const char* noun, const char* plural) {
    if (count > 0) words.push_back(counted(count, noun, plural));
  };
  add(input.faces, "face", "faces");
  add(input.patches, "patch", "patches");
  add(input.curves, "curve", "curves");
  add(input.points, "point", "points");
  return joined(words);
}

std::string hull_text(const Report& report) {
  constexpr std::array kinds = {"point", "segment", "planar", "solid"};
  std::string text = kinds[std::size_t(report.dimension)];
  if (const auto& counts = report.hull.counts) {
    text += ": " + counted(counts->patches, "patch", "patches") + ", " +
            counted(counts->scrolls, "scroll", "scrolls") + ", " +
            counted(counts->facets, "facet", "facets") + ", " +
            counted(counts->curves, "curve", "curves");
    if (counts->unresolved > 0) text += ", " + number(long(counts->unresolved)) + " unresolved";
  }
  if (const auto& tolerant = report.hull.tolerant; tolerant && tolerant->faces > 0) {
    text += ", " + counted(tolerant->faces, "face", "faces") + " off by up to " +
            number(tolerant->bound, 3);
  }
  return text;
}

/// Of points and polygons there is but one method.
std::string mesh_text(const Report& report) {
  const bool curved = report.input.patches > 0 || report.input.curves > 0;
  return counted(report.mesh.faces, "face", "faces") + ", " +
         counted(report.mesh.vertices, "vertex", "vertices") +
         (curved ? ", method " + report.method : "");
}

/// A measure of the hull where it is known, and the mesh's.
std::string measure_text(const Report& report, double Measures::*value) {
  const std::string of_mesh = number(report.mesh.measures.*value, 10);
  if (report.mesh.distance_bound == 0) return of_mesh;
  if (!report.hull.measures) return of_mesh + " of the mesh";
  return number((*report.hull.measures).*value, 10) + ", the mesh's " + of_mesh;
}

std::string distance_text(const Report& report) {
  if (report.mesh.distance_bound == 0) return "none: the mesh is the hull";
  std::string text = "at most " + number(report.mesh.distance_bound, 3) + " from the true hull";
  if (report.input.diagonal > 0) {
    text +=
        ", " + number(report.mesh.distance_bound / report.input.diagonal, 3) + " of the diagonal";
  }
  return text;
}

/// Of each phase that took any.
std::string seconds_text(const Report::Seconds& s) {
  std::string text = number(s.total, 3) + ": read " + number(s.read, 2);
  const auto add = [&](const char* phase, double seconds) {
    if (seconds > 0) text += std::string(", ") + phase + " " + number(seconds, 2);
  };
  add("build", s.build);
  add("sample", s.sample);
  add("cull", s.cull);
  add("trace", s.trace);
  add("stitch", s.stitch);
  add("mesh", s.mesh);
  add("measure", s.measure);
  add("write", s.write);
  return text;
}

}  // namespace

std::string summary(const Report& report, const std::vector<std::string>& written) {
  const Report::Input& input = report.input;
  std::string text = line("input", joined(input.files));
  text += line("", contents_text(input) + ", diagonal " + number(input.diagonal) +
                       (input.unit.empty() ? "" : " " + input.unit));
  text += line("hull", hull_text(report));
  if (const auto& resolution = report.hull.resolution) {
    text += line("resolution", number(resolution->rho, 3) + ": " + reason_of(*resolution));
  }
  text += line("mesh", mesh_text(report));
  constexpr int planar = 2;
  if (report.dimension > planar) text += line("volume", measure_text(report, &Measures::volume));
  if (report.dimension >= planar) {
    text += line("area", measure_text(report, &Measures::area) +
                             (report.dimension == planar ? ", one side" : ""));
  }
  text += line("distance", distance_text(report));
  if (report.hull.dropped > 0) {
    text += line("rounding", "left out " +
                                 counted(report.hull.dropped, "extreme point", "extreme points") +
                                 ", nearer than " + number(report.mesh.distance_bound, 3) +
                                 " to the mesh; --resolution 0 keeps all");
  }
  for (const Report::Mesh::File& file : report.mesh.files) {
    if (file.rounding == 0) continue;
    text += line("rounding", "to float moved vertices of " + file.file + " by at most " +
                                 number(file.rounding, 3));
  }
  text += line("seconds", seconds_text(report.seconds));
  for (const std::string& file : written) text += line("wrote", file);
  return text;
}

}  // namespace taut::tool
