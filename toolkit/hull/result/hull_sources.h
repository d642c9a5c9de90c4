#pragma once

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "taut/hull/result/hull_document.h"

namespace taut {

/// The sources that a hull document names, by their ids in the model: first all are added, then
/// each has its place.
class HullSources {
 public:
  /// Both must outlive it; `files`: per part of the model, the file that it is from.
  HullSources(const Model& model, const std::vector<std::string>& files)
      : model_(model), files_(files) {}

  /// Of a source; -1 of none.
  void add(int id) {
    if (id >= 0) ids_.insert(id);
  }
  /// When all are added, before the rest is asked for.
  void finish() { order_.assign(ids_.begin(), ids_.end()); }
  /// The place of the source with this id; -1 of none.
  int place(int id) const {
    if (id < 0) return -1;
    return int(std::lower_bound(order_.begin(), order_.end(), id) - order_.begin());
  }
  /// All that were added, in order of their ids.
  std::vector<HullDocument::Source> make() const {
    std::vector<HullDocument::Source> sources;
    for (const int id : order_) sources.push_back(source(id));
    return sources;
  }
  /// The model's source with this id. @pre the model has one
  HullDocument::Source source(int id) const;

 private:
  const Model& model_;
  const std::vector<std::string>& files_;
  std::set<int> ids_;
  std::vector<int> order_;
};

}  // namespace taut
