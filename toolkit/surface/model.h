#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "taut/core/progress.h"
#include "taut/surface/control_cage.h"
#include "taut/surface/coordinate_grid.h"
#include "taut/surface/nurbs.h"
#include "taut/surface/polygon_mesh.h"

namespace taut {

/// What a source of contacts is (design: face, edge, vertex).
enum class SourceKind { face, edge, vertex };

/// How a patch ends at one of its four sides.
enum class BorderKind {
  smooth,     ///< another patch continues with the same tangent planes (G1)
  edge,       ///< the surface ends here, or meets its neighbour in a crease
  collapsed,  ///< the whole side is one point (the pole of a sphere, the tip of a cone)
};

/// One side of a patch.
struct Border {
  BorderKind kind = BorderKind::edge;  ///< how the patch ends there
  /// smooth, and an edge in which exactly two sides meet: the patch on the other side (the patch
  /// itself where it closes on itself), else -1.
  int neighbor = -1;
  Side neighbor_side = Side::u0;  ///< the neighbour's side that it meets
  /// The neighbour's free parameter runs the other way.
  bool reversed = false;
  /// edge: the edge and its piece (an index into Part::pieces), else -1; smooth: -1 and its piece
  /// where it is a seam. `piece_reversed`: the piece runs against the border.
  int edge = -1;
  int piece = -1;               ///< see edge
  bool piece_reversed = false;  ///< see edge
  /// collapsed onto a vertex (a tip, or the end of an edge): the vertex; -1 where the surface is
  /// smooth there (a pole).
  int vertex = -1;
};

/// Along which parameters a patch is a straight segment for every value of the other one, or
/// obliquely to them.
struct RuledLines {
  bool u = false;        ///< for every v
  bool v = false;        ///< for every u
  bool oblique = false;  ///< neither along u nor along v
  /// It is a straight segment some way.
  bool any() const { return u || v || oblique; }
  /// As planes are, whatever their parameters.
  bool both() const { return u && v; }
};

/// A Bezier patch of a face with the rectangle of the face's parameters that it covers.
struct Patch {
  BezierPatch bezier;  ///< over [0, 1]^2
  Interval u;          ///< of the face's parameter
  Interval v;          ///< of the face's parameter
  int face = -1;       ///< of the part
  /// Parameters along which it is a straight segment for every value of the other one, up to
  /// rounding: no point inside of such a segment is extreme. Both of a plane patch, whatever its
  /// parameters.
  bool ruled_u = false;
  bool ruled_v = false;  ///< see ruled_u
  /// Neither, but developable: the straight segments run across the parameter lines, or along them
  /// at a speed of their own.
  bool ruled_obliquely = false;
  /// In any of these ways.
  bool ruled() const { return ruled_u || ruled_v || ruled_obliquely; }
  /// By how much the patch misses being ruled: what the rounding of its control points has left of
  /// one that was. Infinity where nothing tells so, as where they were not rounded.
  struct OffRuled {
    double u = infinity, v = infinity;
    double oblique = infinity;  ///< along lines of one direction, whatever the parameters
    dvec3 along = dvec3(0.0);   ///< that direction
    double turned = 0;          ///< sine of the angle by which lines may miss it
    bool any() const { return std::min({u, v, oblique}) < infinity; }
  };
  OffRuled off_ruled;
  /// It is, or was before its control points were rounded.
  bool may_be_ruled() const { return ruled() || off_ruled.any(); }
  /// Those that it misses by no more than a length.
  RuledLines lines(double within) const {
    return {ruled_u || off_ruled.u <= within, ruled_v || off_ruled.v <= within,
            ruled_obliquely || off_ruled.oblique <= within};
  }
  /// Indexed by Side: known to go on smoothly there, whatever its tangent planes say.
  std::array<bool, 4> smooth_sides = {};
  /// The patch stands for a surface that is within the part's deviation bound of it, and to which
  /// it is like in no other way: its curvature tells nothing.
  bool stand_in = false;
  /// The first patch of the part with the same control points, which lies before this one, or -1.
  /// A patch that repeats one takes no part in joins; its borders and corners are those of the
  /// other.
  int repeats = -1;
  /// How: its point (u, v) is the other's point (u, v) with the two exchanged if `swapped`, and
  /// then the first replaced by 1 - u if `reversed_u`, the second by 1 - v if `reversed_v`.
  bool swapped = false;
  bool reversed_u = false;  ///< see swapped
  bool reversed_v = false;  ///< see swapped
  /// Indexed by Side.
  std::array<Border, 4> borders;
  /// Vertex at the corners (u0,v0), (u0,v1), (u1,v0), (u1,v1), or -1 where the corner is none.
  std::array<int, 4> corner_vertex = {-1, -1, -1, -1};
};

/// A Bezier piece of an edge with the interval of the edge's parameter that it covers; or a seam: a
/// smooth join along which supporting planes can change from one surface to another, though it is
/// no edge (Part::connect).
struct EdgePiece {
  BezierCurve bezier;  ///< over [0, 1]
  Interval t;          ///< of the edge's parameter
  int edge = -1;       ///< -1: a seam
  /// How it goes on at t.lower and t.upper: either with a vertex, or straight on (G1) with a piece
  /// of this or another edge, which may run the other way or be this piece itself. The other is -1.
  std::array<int, 2> end_vertex = {-1, -1};
  std::array<int, 2> end_neighbor = {-1, -1};  ///< see end_vertex
};

/// A closed loop of curves in a face's parameters, each beginning where the one before it ends.
/// Their control points are (w u, w v, 0, w). The face lies to the left: outer loops run
/// counter-clockwise, those around holes clockwise.
struct TrimLoop {
  std::vector<NurbsCurve> curves;  ///< in order
};

/// A Bezier patch of a face that is given by patches.
struct FacePatch {
  BezierPatch bezier;  ///< over [0, 1]^2
  /// Indexed by Side: the surface is known to go on smoothly there (Part::connect).
  std::array<bool, 4> smooth_sides = {};
  bool stand_in = false;  ///< see Patch
};

/// What the input calls a face: one surface. Its patches are consecutive in Part::patches.
struct Face {
  std::string name;     ///< as the input has it, or empty
  int first_patch = 0;  ///< in Part::patches
  int patch_count = 0;  ///< of patches
  /// The loops that bound it; none where the whole surface counts.
  std::vector<TrimLoop> loops;
  int cage = -1;  ///< the cage of the part that it belongs to (Part::cages), or none
};

/// A control cage and what became of it.
struct CageOfPart {
  std::shared_ptr<const ControlCage> cage;  ///< as it was read
  /// Its faces whose surface is no single polynomial (at extraordinary vertices, semi-sharp creases
  /// and the like), and those of them that were refined since they may touch the hull.
  long irregular_faces = 0;
  long refined_faces = 0;  ///< see irregular_faces
};

/// A curve where the surface is not smooth or ends, or a free curve; its pieces are consecutive in
/// Part::pieces. Border edges run over [0, number of pieces], free curves over their own domain.
struct Edge {
  std::string name;     ///< as the input has it, or empty
  int first_piece = 0;  ///< in Part::pieces
  int piece_count = 0;  ///< of pieces
  /// Faces that meet in it, ascending, one entry per side: none (a free curve), one (an open
  /// border) or more; the same face twice where it meets itself.
  std::vector<int> faces;
};

/// Geometry in a frame of its own, placed any number of times by instances.
class Part {
 public:
  std::string name;  ///< as the input has it, or empty

  /// Each call validates what it is given; one that throws changes nothing.
  /// @pre not connected @throws InvalidInput
  /// Loops are checked as curves, not for how they lie.
  void add_surface(const NurbsSurface& surface, std::string face_name,
                   std::vector<TrimLoop> loops = {});
  /// A face of any Bezier patches, of which the k-th covers [2 k, 2 k + 1] x [0, 1] of its
  /// parameters: patches that follow each other need not meet, so no two have a place in common.
  void add_patches(std::vector<FacePatch> patches, std::string face_name);
  /// A curve of no face.
  void add_curve(const NurbsCurve& curve, std::string edge_name);
  /// A free point.
  void add_point(const dvec3& point);
  /// Free points.
  void add_points(std::span<const dvec3> points);
  /// The mesh's points, used or not, and its polygons, each a face: of a polygon that is not
  /// planar any surface within the convex hull of its corners. Throws also for indices out of range
  /// and polygons of fewer than three corners, and LimitExceeded beyond 2^31 points.
  void add_polygons(const PolygonMesh& mesh);

  /// Finds how the patches meet: fills borders, edges and vertices. Call once after the last add.
  ///
  /// Before that, faces are split into more patches, exactly, along crests inside of patches:
  /// curves u = const or v = const, not straight, on which the surface has one tangent plane (as on
  /// top of a torus), with no surface on one of its sides; and where a side of another patch that
  /// runs along one of their own, not straight, ends inside of it.
  ///
  /// Two sides meet if their curves agree, parameter by parameter in either direction, within
  /// join_distance of the part's diagonal; the join of exactly two is smooth if the one surface
  /// continues the other with tangent planes that agree within `smooth_angle` everywhere along it
  /// (checked at as many parameters as determine the polynomials involved), or if both are known to
  /// go on smoothly there (FacePatch). Surfaces need not be
  /// oriented alike; one that folds back onto the other is not smooth, though its planes agree.
  ///
  /// All other sides are edges: maximal runs of straight-on borders along which the same sides of
  /// the same faces meet. A vertex stands where edges, free curves included, end in anything but
  /// one straight-on continuation (so also at a kink inside a free curve, which stays one edge),
  /// where a straight segment goes on in a bent one, since it touches planes with its ends, and at
  /// a collapsed side that has no common normal. The points of an edge's pieces and of the
  /// vertices are those of the first side that is there.
  ///
  /// Seams are the smooth joins that get pieces too, for supporting planes can leave a surface
  /// there though it has no edge: those of a ruled patch with one that is not, those of ruled
  /// patches that are not straight, unless the straight segments of the one go on in the other, and
  /// crests as above. Their ends are as those of edges, except that edges do not see them: an edge
  /// goes on where a seam ends beside it, though its pieces end in a vertex there. Seams are no
  /// edges; vertices that stand at their ends alone, and their pieces, come last.
  /// @pre not connected @throws InvalidInput if the angle is not in [0, pi/2]; Cancelled, after
  /// which the part is of no use
  void connect(double smooth_angle, const Progress& progress = {});
  /// connect() was called.
  bool connected() const { return connected_; }

  /// The surfaces.
  const std::vector<Face>& faces() const { return faces_; }
  /// Corners as indices into vertices(). As sources of contacts they are numbered behind faces().
  const std::vector<std::vector<int>>& polygons() const { return polygons_; }
  /// Border edges and free curves.
  const std::vector<Edge>& edges() const { return edges_; }
  /// Points that were added, alone or with polygons, behind these the corners of surfaces and the
  /// ends of edges, and last those that stand at the ends of seams alone.
  const std::vector<dvec3>& vertices() const { return vertices_; }
  /// Vertices at the end of the list that are no sources.
  int seam_vertex_count() const { return seam_vertex_count_; }
  /// Of the vertices, those that were added, alone or with polygons.
  int point_count() const { return connected_ ? point_count_ : int(vertices_.size()); }
  /// Points and polygons are all there is, so that its hull is a polytope.
  bool polyhedral() const { return patches_.empty() && pieces_.empty(); }
  /// Of the faces, in their order.
  const std::vector<Patch>& patches() const { return patches_; }
  /// Those of the edges, in their order, and behind them those of seams.
  const std::vector<EdgePiece>& pieces() const { return pieces_; }
  /// Box of the control points, which contains the geometry.
  const Box& control_box() const { return box_; }

  /// The grid on which the numbers lie that the part was made of: the points of surfaces, curves,
  /// polygons and control cages as they were added. Those of add_patches() do not count: such
  /// patches are computed.
  CoordinateGrid coordinate_grid() const { return stored_coordinates_.grid(); }
  /// How far apart that is, at worst, which connect() took for one: sides that meet (at the
  /// parameters at which they are compared), the points of a side that collapses, and corners.
  double join_gap() const { return join_gap_; }

  /// Where surfaces stand for something that they meet only within a tolerance: a proven bound of
  /// the difference that this makes to the support function of the part, the largest that was told.
  double deviation_bound() const { return deviation_bound_; }
  /// @pre not negative
  void include_deviation(double bound) { deviation_bound_ = std::max(deviation_bound_, bound); }

  /// Control cages whose limit surfaces have been added; their faces are those with Face::cage.
  const std::vector<CageOfPart>& cages() const { return cages_; }
  /// The faces added since `first_face` are the cage's limit surface.
  void add_cage(CageOfPart cage, int first_face);

 private:
  std::vector<Face> faces_;
  std::vector<std::vector<int>> polygons_;
  std::vector<Edge> edges_;
  std::vector<dvec3> vertices_;
  int point_count_ = 0;
  int seam_vertex_count_ = 0;
  std::vector<Patch> patches_;
  std::vector<EdgePiece> pieces_;
  Box box_;
  StoredCoordinates stored_coordinates_;
  bool connected_ = false;
  double join_gap_ = 0;
  double deviation_bound_ = 0;
  std::vector<CageOfPart> cages_;
};

/// A part placed by a rigid motion.
struct Instance {
  int part = 0;      ///< in Model::parts
  RigidMotion pose;  ///< where it stands
};

/// A source of contacts: a face (a surface or polygon), edge or vertex of one instance.
struct Source {
  SourceKind kind = SourceKind::face;  ///< what it is
  int instance = 0;                    ///< in Model::instances
  int index = 0;  ///< into the part's faces and then polygons, its edges or its vertices
};

/// Faces, edges and vertices, in parts that are placed by instances.
///
/// Sources are numbered through: per instance, in order, its faces, then its edges, then its
/// vertices; vertices of seams have no numbers, and count nowhere.
class Model {
 public:
  /// Adds the part, which is connected now if it was not yet, and one instance of it at rest.
  /// Returns the part's index. @throws InvalidInput if the model's extent overflows,
  /// LimitExceeded as add_instance() does, Cancelled
  int add_part(Part part, double smooth_angle, const Progress& progress = {});
  /// Places a part once more. @throws InvalidInput if the index is out of range, the rotation is
  /// not orthogonal with determinant 1 within rotation_tolerance, the translation is not finite
  /// or the model's extent overflows;
  /// LimitExceeded if sources or patches no longer could be numbered by an int
  void add_instance(int part, const RigidMotion& pose);
  /// Takes the instances out (those at rest too), to be placed anew.
  void clear_instances();

  /// By index.
  const std::vector<Part>& parts() const { return parts_; }
  /// In order of their numbers of sources.
  const std::vector<Instance>& instances() const { return instances_; }
  /// The name of the unit of its numbers, "mm"; empty where none is known. Nothing depends on it.
  const std::string& unit() const { return unit_; }
  /// Sets the name of the unit; converts nothing.
  void set_unit(std::string unit) { unit_ = std::move(unit); }

  /// Of all kinds, over all instances.
  int source_count() const;
  /// @pre 0 <= id < source_count()
  Source source(int id) const;
  /// The number of a source. @pre the model has it
  int source_id(const Source& source) const;
  /// All parts are: the hull is a polytope.
  bool polyhedral() const;
  /// Nothing is there, or only empty parts.
  bool empty() const;
  /// Box of all control points and points, which contains the geometry; that of the geometry
  /// itself where the model is polyhedral.
  Box control_box() const;

  /// Numbers over all instances.
  int face_count() const;
  /// Edges, over all instances.
  int edge_count() const;
  /// Vertices that are sources, over all instances.
  int vertex_count() const;
  /// Bezier patches of faces, over all instances.
  int patch_count() const;
  /// The largest of all parts (Part::deviation_bound).
  double deviation_bound() const;

 private:
  void validate_room(const Part& part, const std::string& name) const;

  std::vector<Part> parts_;
  std::vector<Instance> instances_;
  std::string unit_;
  std::vector<int> first_source_;  // per instance
  int source_count_ = 0;
  int patch_count_ = 0;
  Box box_;  // of the parts' control boxes at their places
};

}  // namespace taut
