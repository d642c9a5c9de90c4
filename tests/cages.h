#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "taut/io/model/read_model.h"
#include "taut/surface/control_cage.h"
#include "taut/surface/model.h"

namespace taut_test {

using taut::CageCrease;
using taut::CageScheme;
using taut::ControlCage;
using taut::dvec3;

/// @name Control cages
/// @{
/// Corners at (+-1, +-1, +-1).
ControlCage cube_cage();
ControlCage tetrahedron_cage(CageScheme scheme);
/// m x n quads around a torus of radii 2 and 0.8, all regular.
ControlCage torus_cage(int m, int n);
/// The same of triangles, two for each quad, for the scheme loop: all regular.
ControlCage triangle_torus_cage(int m, int n);
/// A closed, convex body about the z axis with a vertex of the valence at its top and its bottom,
/// in no symmetric position.
ControlCage dome_cage(CageScheme scheme, int valence);
/// A cube with a sharp rim around its top, which is flat, or bent up at two of its corners. At each
/// corner the top is alone between two edges that go on smoothly into each other.
ControlCage rimmed_cage(bool flat);
/// The prism over an L with arms of 2 and widths of 1, one high: vertices 0 to 5 are its bottom's,
/// 6 to 11 those above them.
ControlCage l_profile_cage();
/// The box [-1, 1]^3 in k x k quads a side, without its top, and without its bottom, if it is open
/// there; at height z its sides are `taper` (z + 1) nearer to the axis.
struct BoxCage {
  int k = 1;
  double taper = 0;
  bool open_top = false;
  bool open_bottom = false;
};
ControlCage box_cage(const BoxCage& box);
/// m x n quads of a bulging sheet over [-1, 1]^2, open.
ControlCage sheet_cage(int m, int n);
/// A dome for the scheme loop with two triangles on one of its edges, which share the other two: in
/// all levels there are edges with the same ends.
ControlCage two_sided_fin_cage();
/// The cage of quads cut along a diagonal each, for Loop's scheme.
ControlCage triangulated(ControlCage cage);
/// Makes the edges with both ends there sharp.
void make_sharp(ControlCage& cage, const std::function<bool(const dvec3&)>& is_there,
                double sharpness = taut::infinite_sharpness);
/// The box of k x k squares a side, triangulated, with a rim of sharpness 1.5 about its top.
ControlCage semi_sharp_rim_cage(int k);
/// @}

/// The edges of a dome's rim about its top.
std::vector<CageCrease> rim(const ControlCage& dome, double sharpness);

/// @name Cages of both schemes to try things on, and what they are
/// @{
struct NamedCage {
  std::string name;
  ControlCage cage;
};
/// Closed and without tags; valences of 3 to 12 and 50.
std::vector<NamedCage> smooth_cages();
/// With creases and corners, semi-sharp and sharp, holes and boundaries.
std::vector<NamedCage> tagged_cages();
/// With faces that have a vertex twice.
std::vector<NamedCage> degenerate_cages();
/// All of them.
std::vector<NamedCage> all_cages();
/// Those without boundaries and holes.
std::vector<NamedCage> closed_cages();
/// @}

/// Edges of one face alone that is no hole.
int boundary_edges(const ControlCage& cage);

/// The diagonal of the control points' box.
double size_of(const ControlCage& cage);

/// The cage as a model of one part.
taut::Model cage_model(const ControlCage& cage, double accuracy = 1e-9);
/// The model in a file of the folder that TAUT_MODELS names; none if there is no such file.
std::optional<taut::Model> model_from_elsewhere(const std::string& file,
                                                std::optional<taut::Scheme> scheme,
                                                double accuracy);
/// The cage of a model that is one.
const ControlCage& cage_of(const taut::Model& model);

}  // namespace taut_test
