#include "taut/verify/check_report.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "taut/core/tolerances.h"

namespace taut {
namespace {

/// Lengths in the report are those of the document but for how they were computed.
constexpr double length_accuracy = 1e-12;

/// Of a volume as the sum of prisms over the faces, in units of area times diagonal: a few
/// roundings of each height, beside those of coordinates.
constexpr double volume_rounding = 8 * rounding_unit;

using Json = nlohmann::json;

const Json* find(const Json* object, const std::string& key) {
  if (object == nullptr || !object->is_object()) return nullptr;
  const auto found = object->find(key);
  return found == object->end() ? nullptr : &*found;
}

std::optional<double> number(const Json* value) {
  if (value == nullptr || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

StatedResolution stated_resolution(const Json& report) {
  const Json* exact = find(&report, "hull");
  const double stated = number(find(exact, "resolution")).value_or(0);
  const Json* source = find(exact, "resolution_source");
  return {std::isfinite(stated) ? std::max(stated, 0.0) : 0,
          source != nullptr && (*source == "coordinates" || *source == "joins")};
}

/// Compares one report.
class ReportCheck {
 public:
  ReportCheck(const Json& report, HullFaults& faults) : report_(report), faults_(faults) {}

  /// What the report says, if it does, is the value but for a share of it, and for so much.
  void compare(const std::string& key, const Json* object, double value, double accuracy,
               double error = 0) {
    const Json* said = find(object, key);
    if (said == nullptr) return;
    const std::optional<double> given = number(said);
    const double share = value != 0 ? accuracy * std::abs(value) : 0;
    if (given && std::abs(*given - value) <= share + error) return;
    faults_.add("report", "report: " + key + " is " + (given ? text(*given) : "no number") +
                              ", not " + text(value));
  }
  void compare_counts(const HullDocument& hull);
  void compare_bounds(const HullDocument& hull);
  void compare_measures(const HullDocument& hull, const DocumentMeasures& measures,
                        double rounding);

 private:
  /// All digits: what differs may do so in the last ones.
  static std::string text(double value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return {digits.data(), end.ptr};
  }

  const Json& report_;
  HullFaults& faults_;
};

void ReportCheck::compare_counts(const HullDocument& hull) {
  const auto count = [&](FaceKind kind) {
    return double(std::count_if(hull.faces.begin(), hull.faces.end(),
                                [&](const HullDocument::Face& f) { return f.kind == kind; }));
  };
  compare("dimension", &report_, hull.dimension, 0);
  const Json* exact = find(&report_, "hull");
  compare("patches", exact, count(FaceKind::patch), 0);
  compare("scrolls", exact, count(FaceKind::scroll), 0);
  compare("facets", exact, count(FaceKind::facet), 0);
  compare("curves", exact, double(hull.curves.size()), 0);
  compare("unresolved", exact, 0, 0);
}

void ReportCheck::compare_bounds(const HullDocument& hull) {
  int tolerant = 0;
  double largest = 0;
  for (const HullDocument::Face& face : hull.faces) {
    tolerant += face.tolerant > 0 ? 1 : 0;
    raise(largest, face.tolerant);
  }
  const Json* exact = find(&report_, "hull");
  compare("tolerant", exact, tolerant, 0);
  compare("tolerant_bound", exact, largest, length_accuracy);
}

void ReportCheck::compare_measures(const HullDocument& hull, const DocumentMeasures& measures,
                                   double rounding) {
  const double accuracy = measure_accuracy + rounding;
  const Json* exact = find(&report_, "hull");
  // Two facets or scrolls within their bounds enclose volumes that differ by what is between them,
  // and strips between their outlines.
  compare("volume", exact, measures.volume, accuracy + measures.volume_error,
          measures.volume_bound + (volume_rounding + rounding) * measures.area * hull.diagonal);
  // Where stand-ins or rounded patches meet, normals jump, which integrals of curvature miss:
  // either width is within twice the deviation of that of the surface itself. Places within their
  // bounds move either width by twice the largest, and normals that are not theirs by as much
  // again.
  const Json* subdivision = find(&report_, "subdivision");
  double deviation = number(find(subdivision, "deviation_bound")).value_or(0);
  const StatedResolution resolution = stated_resolution(report_);
  if (resolution.is_of_model) raise(deviation, resolution.length);
  double deepest = 0;
  for (const HullDocument::Face& face : hull.faces) raise(deepest, face.tolerant);
  raise(deviation, deepest);
  const double width = std::abs(measures.mean_width);
  compare("mean_width", exact, measures.mean_width,
          accuracy + measures.mean_width_error + 4 * deviation / width);
  // The area between parallel surfaces so far apart, by Steiner's formula, of either; of what is
  // thin the rounding of places tells as well.
  const double of_places = 8 * std::numbers::pi * (deepest + rounding * hull.diagonal) * width;
  compare(
      "area", exact, measures.area,
      accuracy + measures.area_error + (measures.vector_area_bound + of_places) / measures.area);
}

}  // namespace

StatedResolution stated_resolution(const HullDocument& hull) {
  return stated_resolution(Json::parse(hull.report, nullptr, false));
}

double stated_gap(const HullDocument& hull) {
  const Json report = Json::parse(hull.report, nullptr, false);
  const double gap = number(find(find(&report, "hull"), "gap_bound")).value_or(0);
  return std::isfinite(gap) ? std::max(gap, 0.0) : 0;
}

std::optional<double> stated_mean_width(const HullDocument& hull) {
  const Json report = Json::parse(hull.report, nullptr, false);
  return number(find(find(&report, "hull"), "mean_width"));
}

void check_report(const HullDocument& hull, const std::optional<DocumentMeasures>& measures,
                  double rounding, HullFaults& faults) {
  if (hull.report.empty()) return;
  try {
    const Json report = Json::parse(hull.report);
    ReportCheck check(report, faults);
    check.compare_counts(hull);
    check.compare_bounds(hull);
    if (measures) check.compare_measures(hull, *measures, rounding);
  } catch (const Json::parse_error& error) {
    faults.add("report", std::string("report: ") + error.what());
  }
}

}  // namespace taut
