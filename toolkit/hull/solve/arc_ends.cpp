#include "taut/hull/solve/arc_ends.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "taut/bounds/contact_climb.h"
#include "taut/bounds/contact_forms.h"
#include "taut/hull/contact/joined_elements.h"
#include "taut/hull/contact/rulings_between.h"
#include "taut/hull/solve/arc_pieces.h"
#include "taut/hull/solve/arc_solver.h"
#include "taut/hull/solve/merged_ends.h"

namespace taut {
namespace {

/// Parts of the last way to a free end, at whose ends rulings are looked for.
constexpr int found_places = 16;
/// Rulings at a free end are no shorter: the root of what rounding moves contacts by that are so
/// near to each other (merge_distance).
constexpr double shortest_merging = 1e-4;

double length_of(const Ruling& r) { return glm::distance(r.point[0], r.point[1]); }

bool is_close(const Ruling& a, const Ruling& b) {
  return glm::distance(a.n, b.n) <= pole_chord &&
         glm::distance(a.point[0], b.point[0]) <= pole_chord &&
         glm::distance(a.point[1], b.point[1]) <= pole_chord;
}

class ArcEndSearch {
 public:
  ArcEndSearch(const RulingSearch& search, const std::optional<Ruling>& told)
      : search_(search), geometry_(search.geometry()), told_(told) {}

  /// Where they run on different surfaces or curves the system of two contacts is worse by the
  /// square of their distance, not by its third power as merging_distance() has it.
  bool is_near(const Ruling& r) const {
    const double distance = merging_distance(geometry_);
    const bool is_smooth = continues(geometry_, r.contact[0], r.contact[1]);
    return length_of(r) <= (is_smooth ? distance : std::pow(distance, 1.5));
  }

  /// Adds what is left of the arc, if its end is told and the way there supports; if `surely`, and
  /// rulings are found all along the last part.
  bool ends(std::vector<ArcPiece>& pieces, bool surely) const {
    const Ruling last = pieces.back().rulings.back();
    const std::optional<Ruling> end = told_ ? told_beside(last) : merged_ruling(search_, last);
    if (!end) return false;
    ArcSolver solver(search_, last);
    solver.go_on(*end);
    std::vector<ArcPiece> way = solver.take();
    const double resolution = search_.map().resolution;
    if (std::any_of(way.begin(), way.end(),
                    [&](const ArcPiece& piece) { return piece.tolerant > resolution; })) {
      return false;
    }
    if (surely &&
        !std::all_of(way.begin(), way.end(), [&](const auto& p) { return is_found(p); })) {
      return false;
    }
    append(pieces, std::move(way));
    return true;
  }

  /// A ruling ahead that is shorter by a quarter, or by less; none where rounding moves contacts.
  std::optional<Ruling> shorter(const Ruling& r) const {
    for (const double share : {0.75, 0.875}) {
      const double length = share * length_of(r);
      if (length < shortest_merging) break;
      const std::optional<Ruling> next = with_length(r, length);
      if (next && follows(r, *next) && search_.depth(*next) <= search_.map().resolution) {
        return next;
      }
    }
    return std::nullopt;
  }

 private:
  /// The end that is told, in the elements of the ruling before it, as far as it lies in these.
  Ruling told_beside(const Ruling& last) const {
    Ruling end = *told_;
    for (std::size_t i = 0; i < 2; ++i) {
      if (const auto own = expressed_in(geometry_, end.contact[i], last.contact[i])) {
        end.contact[i] = *own;
      }
    }
    return end;
  }

  bool is_found(const ArcPiece& piece) const {
    const std::vector<Ruling>& r = piece.rulings;
    if (r.size() < 2 || length_of(r[r.size() - 2]) < shortest_solved) return true;
    const RulingsBetween between(search_.system(), r[r.size() - 2], r.back());
    for (int place = 1; place < found_places && !between.empty(); ++place) {
      if (!between(double(place) / found_places)) return false;
    }
    return true;
  }

  /// Not beyond an end in which another arc begins: halfway between the two the length is between
  /// theirs.
  bool follows(const Ruling& from, const Ruling& to) const {
    if (!same_elements(from, to)) return true;
    const auto middle = ruling_between(search_.system(), from, to, 0.5);
    return middle && length_of(*middle) > length_of(to);
  }

  /// Of contacts that have run over into other elements on the way, with those.
  std::optional<Ruling> with_length(const Ruling& r, double length) const {
    CommonSupport s(geometry_, r);
    for (int k = 0; k < most_moves; ++k) {
      const bool solved = search_.system().solve(
          s, [&](const CommonSupport& now) { return distance_equation(now, length); });
      if (!solved) return std::nullopt;
      if (!stays(s)) continue;
      return is_inside(s.contact[0]) && is_inside(s.contact[1]) ? std::optional(s.ruling())
                                                                : std::nullopt;
    }
    return std::nullopt;
  }

  bool is_inside(const Contact& c) const {
    return glm::distance(geometry_.point(clamped(c)), geometry_.point(c)) <= geometry_.tie();
  }

  /// False if a contact has been moved to the element that it has run over into.
  bool stays(CommonSupport& s) const {
    bool stays = true;
    for (std::size_t i = 0; i < 2; ++i) {
      Contact& c = s.contact[i];
      if (is_inside(c) && c.kind == SourceKind::face) continue;
      const std::optional<Contact> there = climbed(geometry_, clamped(c), s.n);
      if (!there || same_element(*there, c)) continue;
      c = geometry_.first(*there);
      stays = false;
    }
    if (!stays) s.evaluate(geometry_);
    return stays;
  }

  static constexpr int most_moves = 4;

  const RulingSearch& search_;
  const ContactGeometry& geometry_;
  const std::optional<Ruling>& told_;
};

}  // namespace

void drop_close_to_pole(const ContactGeometry& geometry, const Ruling& end_ruling,
                        std::vector<Ruling>& known, int end) {
  if (!lies_at_pole(geometry, end_ruling)) return;
  while (known.size() > 1 && is_close(end == 0 ? known.front() : known.back(), end_ruling)) {
    known.erase(end == 0 ? known.begin() : known.end() - 1);
  }
}

void merge(const RulingSearch& search, std::vector<ArcPiece>& pieces,
           const std::optional<Ruling>& told) {
  const ArcEndSearch ends(search, told);
  for (;;) {
    const Ruling last = pieces.back().rulings.back();
    if (ends.is_near(last) && ends.ends(pieces, true)) return;
    const std::optional<Ruling> next = ends.shorter(last);
    if (!next && ends.ends(pieces, false)) return;
    ArcSolver solver(search, last);
    if (next || told) {
      solver.go_on(next ? *next : *told);
    } else {
      // How deep what is left of the arc lies is told with its pieces.
      solver.end_in_one_contact();
    }
    append(pieces, solver.take());
    if (!next) return;
  }
}

}  // namespace taut
