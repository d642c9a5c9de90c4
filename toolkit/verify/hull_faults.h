#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace taut {

/// Something wrong with a hull document.
struct HullFault {
  std::string check;  ///< that found it: "sources", "kinds", "order", "regions", "measures", ...
  std::string text;   ///< where and what: "curves[3]: a join within one source face"
};

/// Faults, no more of each check than one wants to read.
class HullFaults {
 public:
  /// Adds one, unless its check has found too many already.
  void add(const std::string& check, std::string text) {
    const auto of_check = [&](const HullFault& f) { return f.check == check; };
    if (std::count_if(faults_.begin(), faults_.end(), of_check) < limit) {
      faults_.push_back({check, std::move(text)});
    }
  }
  /// In the order in which they were added.
  const std::vector<HullFault>& list() const { return faults_; }

 private:
  static constexpr int limit = 8;
  std::vector<HullFault> faults_;
};

/// Keeps the larger one. A length that is no number is as bad as can be.
inline void raise(double& worst, double value) {
  worst = std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(worst, value);
}

}  // namespace taut
