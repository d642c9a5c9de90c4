#pragma once

#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "shapes.h"
#include "taut/bounds/scene.h"
#include "taut/surface/model.h"

namespace taut_test {

using namespace taut::shapes;  // NOLINT: shapes

using taut::BezierCurve;
using taut::BezierPatch;
using taut::dmat3;
using taut::dvec3;
using taut::dvec4;
using taut::Model;
using taut::NurbsCurve;
using taut::NurbsSurface;

inline constexpr double pi = std::numbers::pi;

using Random = std::mt19937_64;

double uniform(Random& random, double lower, double upper);
/// Uniform in the logarithm. @pre 0 < lower < upper
double log_uniform(Random& random, double lower, double upper);
/// lower <= result <= upper
int pick(Random& random, int lower, int upper);
dvec3 random_point(Random& random);
dvec3 random_direction(Random& random);
dmat3 random_rotation(Random& random);
/// A rotation whose axis and angle are no round numbers.
dmat3 skew_rotation();

Model make_model(const Shape& shape);
taut::Scene make_scene(const Shape& shape, int threads = 1);

/// The Utah teapot from the data folder.
Shape teapot();
/// As many teapots, one part, in random poses in a box of half their number times the box of one:
/// they overlap loosely.
Model posed_teapots(unsigned seed, int count);

/// A closed smooth body of size about two with one to three dents, in general position: 24 bicubic
/// patches, C2 but for two poles, at which it is G1.
Shape blob(unsigned seed);

/// @name Random geometry of size about one
/// Draws stand in braces or in statements of their own: the order in which compilers evaluate
/// arguments differs, and all are to try the same models.
/// @{
struct DegreeRange {
  int lower, upper;
};
/// Weights are log-uniform in [1 / weight_range, weight_range]; polynomial if it is one.
BezierPatch random_patch(Random& random, int degree_u, int degree_v, double weight_range);
/// Each of the degrees picked from the range.
BezierPatch random_patch(Random& random, DegreeRange degrees, double weight_range);
BezierCurve random_curve(Random& random, int degree, double weight_range);
/// @}

}  // namespace taut_test
