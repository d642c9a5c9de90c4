#include "taut/subdivision/refiner.h"

#include <opensubdiv/far/error.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <string>

#include "taut/core/error.h"

namespace taut {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

int to_int(std::size_t n) { return static_cast<int>(n); }

Sdc::SchemeType scheme_type(CageScheme scheme) {
  return scheme == CageScheme::loop ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
}

/// What OpenSubdiv says of a mistake goes into the exception, not to the terminal.
std::string& last_error() {
  thread_local std::string message;
  return message;
}

void keep_error(Far::ErrorType, const char* message) { last_error() = message; }
void pass_warning(const char*) {}

}  // namespace

std::unique_ptr<Far::TopologyRefiner> make_refiner(const Description& description,
                                                   CageScheme scheme, const Sdc::Options& options) {
  static const bool silenced = [] {
    Far::SetErrorCallback(keep_error);
    Far::SetWarningCallback(pass_warning);
    return true;
  }();
  static_cast<void>(silenced);
  Far::TopologyDescriptor d;
  d.numVertices = to_int(description.point_count);
  d.numFaces = to_int(description.sizes.size());
  d.numVertsPerFace = description.sizes.data();
  d.vertIndicesPerFace = description.vertices.data();
  d.numCreases = to_int(description.crease_sharpness.size());
  d.creaseVertexIndexPairs = description.crease_vertices.data();
  d.creaseWeights = description.crease_sharpness.data();
  d.numCorners = to_int(description.corner_sharpness.size());
  d.cornerVertexIndices = description.corner_vertices.data();
  d.cornerWeights = description.corner_sharpness.data();
  d.numHoles = to_int(description.holes.size());
  d.holeIndices = description.holes.data();
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  last_error().clear();
  std::unique_ptr<Far::TopologyRefiner> refiner(
      Factory::Create(d, Factory::Options(scheme_type(scheme), options)));
  if (!refiner) {
    throw BackendError("OpenSubdiv does not take the cage" +
                       (last_error().empty() ? std::string() : ": " + last_error()));
  }
  return refiner;
}

}  // namespace taut
