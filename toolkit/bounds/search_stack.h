#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace taut {

/// What a branch and bound search has still to look at. The last entry comes first until
/// turn_best_first(), the highest one from then on. An Entry has an upper `bound`, by which they
/// are ordered.
template <class Entry>
class SearchStack {
 public:
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  /// The last entry comes first again.
  void clear() {
    entries_.clear();
    best_first_ = false;
  }
  void push(const Entry& entry) {
    entries_.push_back(entry);
    if (best_first_) std::push_heap(entries_.begin(), entries_.end());
  }
  /// Brings the highest of the entries from the first `size` on to the top.
  void highest_last(std::size_t size) {
    if (best_first_ || entries_.size() < size + 2) return;
    const auto begin = entries_.begin() + std::ptrdiff_t(size);
    std::iter_swap(std::max_element(begin, entries_.end()), entries_.end() - 1);
  }
  void turn_best_first() {
    best_first_ = true;
    std::make_heap(entries_.begin(), entries_.end());
  }
  /// @pre not empty
  Entry pop() {
    if (best_first_) std::pop_heap(entries_.begin(), entries_.end());
    const Entry entry = entries_.back();
    entries_.pop_back();
    return entry;
  }
  /// The highest bound; minus infinity without entries.
  double highest() const {
    double result = -std::numeric_limits<double>::infinity();
    for (const Entry& entry : entries_) result = std::max(result, entry.bound);
    return result;
  }

 private:
  std::vector<Entry> entries_;
  bool best_first_ = false;
};

}  // namespace taut
