#include "cages.h"
#include "families.h"

namespace taut_test {
namespace {

taut::ControlCage disturbed(taut::ControlCage cage, Random& random) {
  const double size = size_of(cage);
  for (dvec3& p : cage.points) p += 0.05 * size * random_point(random);
  return cage;
}
Natural smooth_cage(Random& random) { return {{}, {}, disturbed(cube_cage(), random)}; }
Natural loop_cage(Random& random) {
  return {{}, {}, disturbed(tetrahedron_cage(CageScheme::loop), random)};
}
Natural ring_cage(Random& random) {
  return {{}, {}, disturbed(torus_cage(pick(random, 4, 6), pick(random, 4, 6)), random)};
}
Natural creased_cage(Random& random) {
  taut::ControlCage cage = disturbed(cube_cage(), random);
  const double least = cage.points[0].z;
  make_sharp(
      cage, [&](const dvec3& p) { return p.z >= least; }, 2.5);
  return {{}, {}, cage};
}
Natural open_cage(Random& random) { return {{}, {}, disturbed(sheet_cage(4, 4), random)}; }
Natural profile_cage(Random& random) { return {{}, {}, disturbed(l_profile_cage(), random)}; }

}  // namespace

std::vector<Family> cages() {
  return {
      {"smooth_cage", smooth_cage},   {"loop_cage", loop_cage}, {"ring_cage", ring_cage},
      {"creased_cage", creased_cage}, {"open_cage", open_cage}, {"profile_cage", profile_cage},
  };
}

}  // namespace taut_test
