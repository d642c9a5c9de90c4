#pragma once

#include <map>
#include <optional>

#include "taut/verify/document_rulings.h"

namespace taut {

/// A stretch of the outline of a patch's region between two of its points, in the source's
/// parameters.
struct OutlineStretch {
  enum class Kind {
    track,   ///< of a scroll's contact: an interval between two of its rulings
    border,  ///< along a side of the Bezier patch, or no longer than rounding
    free     ///< anything else
  };
  Kind kind = Kind::free;
  dvec2 from = dvec2(0.0), to = dvec2(0.0);
  /// track: the interval, the contact (0 or 1) that runs along here, and whether backwards.
  const RulingInterval* interval = nullptr;
  int contact = 0;
  bool reversed = false;
  /// free: the points of the free stretches on end that it is one of, and which of these it is.
  std::vector<dvec2> line;
  std::size_t place = 0;
};

/// A region of a patch with its outline as exact as the document's rulings tell.
class RegionOutline {
 public:
  int face = -1;
  const HullDocument::Region* region = nullptr;
  std::vector<std::vector<OutlineStretch>> loops;

  /// Where a place of the source's parameters lies: how often the outline runs around it, and
  /// whether it is too near to the outline to tell.
  struct Location {
    int winding = 0;
    bool near = false;
  };
  Location locate(const dvec2& uv) const;
  /// Inside, or too near to tell.
  bool may_contain(const dvec2& uv) const;
  /// The place of the outline, about, that is nearest in shares of the Bezier patch's domain; the
  /// place itself where there is no outline.
  dvec2 nearest(const dvec2& uv) const;
  const dvec2& lower() const { return lower_; }
  const dvec2& upper() const { return upper_; }
  /// Area in the source's parameters.
  double area() const;

  void refine(const DocumentGeometry& geometry, int source);

 private:
  /// A straight piece of the refined outline; the true one is within `slack` of it.
  struct Piece {
    dvec2 from, to;
    double slack = 0;
  };
  dvec2 size_ = dvec2(1.0);  ///< of the Bezier patch's domain
  dvec2 lower_, upper_;
  std::vector<Piece> pieces_;
};

/// All scrolls' intervals and all regions' outlines of a document.
class DocumentOutlines {
 public:
  explicit DocumentOutlines(const DocumentGeometry& geometry);
  DocumentOutlines(const DocumentOutlines&) = delete;
  DocumentOutlines& operator=(const DocumentOutlines&) = delete;

  /// Per face; none but of scrolls.
  const std::vector<std::vector<RulingInterval>>& intervals() const { return intervals_; }
  const std::vector<RegionOutline>& regions() const { return regions_; }
  /// A source's regions, as places in regions().
  const std::vector<int>& regions_of(int source) const;
  /// The stretch between two points of an outline on a source.
  OutlineStretch stretch(int source, const dvec2& from, const dvec2& to) const;
  /// The stretch along a side of one of the source's Bezier patches, be it a track; none if there
  /// is no such side.
  std::optional<OutlineStretch> border(int source, const dvec2& from, const dvec2& to) const;
  /// Whether a region of the source may contain the place.
  bool covers(int source, const dvec2& uv) const;

 private:
  void add_tracks(const DocumentGeometry& geometry);
  void add_regions(const DocumentGeometry& geometry);
  static void join_free_stretches(std::vector<OutlineStretch>& loop);

  using Key = std::array<double, 5>;
  const DocumentGeometry& geometry_;
  std::vector<std::vector<RulingInterval>> intervals_;
  std::map<Key, OutlineStretch> tracks_;
  std::vector<RegionOutline> regions_;
  std::vector<std::vector<int>> regions_of_;
};

}  // namespace taut
