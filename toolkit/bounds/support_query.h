#pragma once

#include <memory>
#include <vector>

#include "taut/bounds/contact.h"
#include "taut/core/stop.h"

namespace taut {

struct SceneContent;  // of a Scene, which converts to it

/// The support function's value at a direction, with the place where it is attained and a proof.
/// Lengths and points are in the scene's frame (Scene::frame).
struct Support {
  /// x(n) . n of the contact found, to within a few rounding units of the scene's size.
  double h = 0;
  /// Proven upper bound of max over the model of x . n, rounding included.
  double h_bound = 0;
  /// By how much the answer may be too low, as lines do not count (SupportQuery::leave_out_lines).
  double low = 0;
  Contact contact;  ///< where h is attained
  /// The contact's point.
  dvec3 point = dvec3(0.0);

  /// At most this is x . n anywhere on the model, rounding and SupportQuery::leave_out apart.
  double highest() const { return h + low; }
};

/// Which bounds prune the search; all give the same answers.
enum class SupportBounds {
  bezier_nets,  ///< Bernstein coefficients of x . n, subdivided on the fly
  coons,        ///< corners and deviations of the CBVH, Bernstein coefficients below its leaves
};

/// Answers support queries on one scene: best-first branch and bound down to where a second-order
/// bound on the Bernstein coefficients proves the point that Newton's method found.
///
/// Holds scratch memory, so use one object a thread; the scene must outlive it.
class SupportQuery {
 public:
  /// `stop`: makes the query that runs throw Cancelled, and each one after.
  explicit SupportQuery(const SceneContent& scene, Stop stop = {},
                        SupportBounds bounds = SupportBounds::bezier_nets);
  ~SupportQuery();
  /// Leaves the other one to be destroyed.
  SupportQuery(SupportQuery&&) noexcept;

  /// The support in direction n. h_bound - h is about 2^-43 of the scene's size and what rounding
  /// may amount to, in all below 1e-12 for degrees up to 9, whatever the weights; more for higher
  /// degrees, for models turned far from the origin, and where the search met its limit of cells.
  /// h_bound is proven in any case.
  ///
  /// `hint`: a contact near the answer, usually that of a nearby direction; makes the query faster,
  /// never different in h beyond h_bound - h.
  /// @pre |n| = 1 within rounding @throws Cancelled
  Support operator()(const dvec3& n, const Contact& hint = {});

  /// The larger of `least` and what Support::highest() is in direction n. What is lower is not told
  /// apart, which takes less the farther `least` is above the support's slack.
  /// @pre |n| = 1 within rounding @throws Cancelled
  double highest_above(double least, const dvec3& n, const Contact& hint = {});

  /// Patches that do not count, with their borders, from now on: the answers are those of the rest.
  void leave_out(const std::vector<Contact>& patches);

  /// Nor do insides of lines that miss being straight by no more (Patch::lines), in the scene's
  /// frame: Support::low tells what that may cost.
  void leave_out_lines(double off);

  /// What works long on the same and asks for no support asks now and then. @throws Cancelled
  void check_stop() const;

  /// Since construction.
  long queries() const;
  /// Steps of Newton's method, since construction.
  long newton_iterations() const;
  /// Cells split and cells certified by the second-order bound.
  long cells() const;

 private:
  class Search;
  std::unique_ptr<Search> search_;
};

}  // namespace taut
