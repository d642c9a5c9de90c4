#pragma once

#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "taut/hull/stitch/edge_incidence.h"
#include "taut/hull/stitch/trim_loops.h"

namespace taut {

/// Points between the ends of a stretch of a border, and one.
inline constexpr int border_points = 8;

/// All stretches of the outlines of a hull's regions, numbered from region to region, and how they
/// lie along each other.
class TrimStretches {
 public:
  /// Stretches on edges are split where what lies beyond the edge changes (EdgeIncidence). Where
  /// two patches do not agree on which part of their join is on the hull, that is added to
  /// `unresolved`. The geometry must outlive this.
  TrimStretches(const ContactGeometry& geometry, const SeparatingGraph& graph,
                std::vector<TrimRegion> regions, std::vector<Unresolved>& unresolved);

  const std::vector<TrimRegion>& regions() const { return regions_; }
  /// The regions, in which every stretch has its curve. This is of no use then.
  std::vector<TrimRegion> take() { return std::move(regions_); }
  /// The model's face in which the region lies.
  int source_of(int region) const;

  int count() const { return int(places_.size()); }
  int number(int region, std::size_t loop, std::size_t index) const {
    return first_of_loop_.at({region, loop}) + int(index);
  }
  struct Place {
    int region;
    std::size_t loop, index;
  };
  const Place& place(int stretch) const { return places_[std::size_t(stretch)]; }
  int region_of(int stretch) const { return place(stretch).region; }
  /// The one that goes on in the same loop.
  int next(int stretch) const;
  /// On a smooth border the same one as the neighbouring patch has it; -1 elsewhere.
  int twin(int stretch) const { return twin_[std::size_t(stretch)]; }
  /// Those along a contact of a piece of an arc.
  std::span<const int> along(int arc, int piece, int contact) const;
  /// Points along a stretch of a border, its ends among them.
  std::vector<dvec3> polyline(int stretch) const;

  /// The hull's curve that it is part of, -1 as long as there is none.
  int curve_of(int stretch) const { return (*this)[stretch].curve; }
  void set_curve(int stretch, int curve);

 private:
  const TrimRegion& region_at(int stretch) const {
    return regions_[std::size_t(region_of(stretch))];
  }
  const TrimStretch& operator[](int stretch) const {
    return region_at(stretch).loops[place(stretch).loop][place(stretch).index];
  }
  const Border& border(const TrimRegion& region, Side side) const;
  dvec3 normal(const TrimRegion& region, Side side, double t) const;

  std::vector<TrimStretch> split(const EdgeIncidence& incidence, const TrimRegion& region,
                                 const std::vector<TrimStretch>& loop) const;
  void number_all();
  void match_joins(std::vector<Unresolved>& unresolved);
  int find_twin(int stretch, const std::vector<int>& candidates) const;

  const ContactGeometry& geometry_;
  std::vector<TrimRegion> regions_;
  std::vector<Place> places_;
  std::map<std::pair<int, std::size_t>, int> first_of_loop_;  // by region and loop
  std::vector<int> twin_;
  std::map<std::tuple<int, int, int>, std::vector<int>> along_;  // by arc, piece and contact
};

}  // namespace taut
