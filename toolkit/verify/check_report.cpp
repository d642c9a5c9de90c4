#include "taut/io/check_report.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "taut/io/document_tree.h"

namespace taut {
namespace {

/// Measures that a report says are known no better than this are compared as if they were.
constexpr double least_accuracy = 1e-7;

const DocumentValue* find(const DocumentValue* object, std::string_view key) {
  if (object == nullptr) return nullptr;
  const auto* members = std::get_if<DocumentValue::Object>(&object->value);
  if (members == nullptr) return nullptr;
  for (const DocumentMember& member : *members) {
    if (member.key == key) return &member.value;
  }
  return nullptr;
}

std::optional<double> number(const DocumentValue* value) {
  if (value == nullptr) return std::nullopt;
  if (const auto* whole = std::get_if<std::int64_t>(&value->value)) return double(*whole);
  if (const auto* real = std::get_if<double>(&value->value)) return *real;
  return std::nullopt;
}

/// Compares one report.
class ReportCheck {
 public:
  ReportCheck(const DocumentValue& report, HullFaults& faults) : report_(report), faults_(faults) {}

  /// What the report says, if it does, is the value but for a share of it.
  void compare(const std::string& key, const DocumentValue* object, double value, double accuracy) {
    const DocumentValue* said = find(object, key);
    if (said == nullptr) return;
    const std::optional<double> given = number(said);
    if (given && std::abs(*given - value) <= accuracy * std::abs(value)) return;
    faults_.add("report", "report: " + key + " is " + (given ? text(*given) : "no number") +
                              ", not " + text(value));
  }
  void compare_counts(const HullDocument& hull);
  void compare_measures(const DocumentMeasures& measures, double accuracy);

 private:
  /// All digits: what differs may do so in the last ones.
  static std::string text(double value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return {digits.data(), end.ptr};
  }

  const DocumentValue& report_;
  HullFaults& faults_;
};

void ReportCheck::compare_counts(const HullDocument& hull) {
  const auto count = [&](FaceKind kind) {
    return double(std::count_if(hull.faces.begin(), hull.faces.end(),
                                [&](const HullDocument::Face& f) { return f.kind == kind; }));
  };
  compare("dimension", &report_, hull.dimension, 0);
  const DocumentValue* exact = find(&report_, "hull");
  compare("patches", exact, count(FaceKind::patch), 0);
  compare("scrolls", exact, count(FaceKind::scroll), 0);
  compare("facets", exact, count(FaceKind::facet), 0);
  compare("curves", exact, double(hull.curves.size()), 0);
  compare("unresolved", exact, 0, 0);
}

void ReportCheck::compare_measures(const DocumentMeasures& measures, double accuracy) {
  const DocumentValue* exact = find(&report_, "hull");
  accuracy += std::min(number(find(exact, "measures_accuracy")).value_or(0), least_accuracy);
  compare("volume", exact, measures.volume, accuracy);
  compare("area", exact, measures.area, accuracy);
  // Where stand-ins meet, normals jump, which integrals of curvature miss: either width is within
  // twice the deviation of that of the surface itself.
  const DocumentValue* subdivision = find(&report_, "subdivision");
  const double deviation = number(find(subdivision, "deviation_bound")).value_or(0);
  compare("mean_width", exact, measures.mean_width,
          accuracy + 4 * deviation / std::abs(measures.mean_width));
}

}  // namespace

void check_report(const HullDocument& hull, const std::optional<DocumentMeasures>& measures,
                  double rounding, HullFaults& faults) {
  if (hull.report.empty()) return;
  try {
    const DocumentValue report = parse_json("report", hull.report);
    ReportCheck check(report, faults);
    check.compare_counts(hull);
    if (measures)
      check.compare_measures(*measures, measure_accuracy + rounding + measures->interpolation);
  } catch (const Error& error) {
    faults.add("report", error.what());
  }
}

}  // namespace taut
