#pragma once

#include <array>
#include <vector>

#include "taut/bounds/contact_exits.h"
#include "taut/hull/solve/ruling_search.h"

namespace taut {

class ContactWay;
class RulingsBetween;

/// A separating curve as it becomes known, from ruling to ruling.
class ArcSolver {
 public:
  /// It must outlive this. Begins with a ruling.
  ArcSolver(const RulingSearch& search, const Ruling& first);

  /// Goes on to a ruling of the same curve: with others between, so dense that they follow each
  /// other smoothly, and a piece for each pair of elements that the contacts are in.
  void go_on(const Ruling& to);
  /// How often ways between rulings have been divided.
  int divisions() const { return all_divisions_; }

  /// Ends where one of the two contacts is, that of the lowest kind: the other goes straight there.
  void end_in_one_contact();

  /// Where no rulings were found between two others, pieces say how far what is between these is
  /// below the supporting planes (ArcPiece::tolerant).
  std::vector<ArcPiece> take() { return std::move(pieces_); }

 private:
  /// Where a contact passes from one element into the next.
  struct Change {
    Ruling before, after;
    double way = 0;  ///< share of that to where it leads
  };
  using ContactWays = std::array<ContactWay, 2>;

  const Ruling& last() const { return pieces_.back().rulings.back(); }
  void append(const Ruling& r) { pieces_.back().rulings.push_back(r); }
  void go_on(const Ruling& to, int depth);
  Ruling told_as_last(Ruling to) const;
  bool stays(const Ruling& to, double distance);
  bool is_beyond(const Ruling& to, double distance);
  bool is_smooth(const Ruling& to);
  Ruling inside(Ruling r) const;
  bool is_interpolated(const RulingsBetween& between) const;
  bool passes_pole(const Ruling& to) const;
  bool is_well_told(const RulingsBetween& between) const;
  bool step_over(const Ruling& to, double depth);
  void divide(const Ruling& to, int depth);
  void jump(const Ruling& to);
  void leap(const Ruling& to, const ContactWays& ways);
  double depth_on_the_way(const Ruling& to, const ContactWays& ways) const;
  bool leaves(const CommonSupport& s, const Ruling& to, std::size_t i,
              const ContactExit& exit) const;
  bool solve_change(CommonSupport& s, const Ruling& to, std::size_t i,
                    const ContactExit& exit) const;
  std::optional<Change> change(const Ruling& to, std::size_t i, const ContactExit& exit,
                               double depth) const;

  const RulingSearch& search_;
  const ContactGeometry& geometry_;
  std::vector<ArcPiece> pieces_;
  int divisions_ = 0;
  int all_divisions_ = 0;
  int passed_ = 0;  ///< changes of elements since the last ruling asked for
};

}  // namespace taut
