#include "taut/subdivision/refiner.h"

#include <opensubdiv/far/error.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <span>
#include <string>

#include "taut/core/error.h"
#include "taut/core/integers.h"
#include "taut/subdivision/extraction.h"

namespace OpenSubdiv::OPENSUBDIV_VERSION::Far {
namespace {

using ExtractionFactory = TopologyRefinerFactory<taut::Extraction>;

void copy(std::span<const int> from, IndexArray to) {
  std::copy(from.begin(), from.end(), to.begin());
}

}  // namespace

// NOLINTBEGIN(readability-identifier-naming): the names are OpenSubdiv's
template <>
bool ExtractionFactory::resizeComponentTopology(TopologyRefiner& refiner,
                                                const taut::Extraction& part) {
  const auto vertices = static_cast<int>(part.vertices().size());
  const auto faces = static_cast<int>(part.faces().size());
  const auto edges = static_cast<int>(part.edges().size());
  setNumBaseVertices(refiner, vertices);
  setNumBaseFaces(refiner, faces);
  setNumBaseEdges(refiner, edges);
  const auto count = [](const taut::Incidence& incidence, int i) {
    return static_cast<int>(incidence[static_cast<std::size_t>(i)].size());
  };
  // Each relation in a loop of its own: GCC 12 (-O3) sets wrong offsets where one sets two.
  for (int f = 0; f < faces; ++f) {
    setNumBaseFaceVertices(refiner, f, count(part.face_vertices(), f));
  }
  for (int e = 0; e < edges; ++e) setNumBaseEdgeFaces(refiner, e, count(part.edge_faces(), e));
  for (int v = 0; v < vertices; ++v) {
    setNumBaseVertexFaces(refiner, v, count(part.vertex_faces(), v));
  }
  for (int v = 0; v < vertices; ++v) {
    setNumBaseVertexEdges(refiner, v, count(part.vertex_edges(), v));
  }
  return true;
}

template <>
bool ExtractionFactory::assignComponentTopology(TopologyRefiner& refiner,
                                                const taut::Extraction& part) {
  for (std::size_t i = 0; i < part.faces().size(); ++i) {
    const auto f = static_cast<Index>(i);
    copy(part.face_vertices()[i], getBaseFaceVertices(refiner, f));
    copy(part.face_edges()[i], getBaseFaceEdges(refiner, f));
  }
  for (std::size_t i = 0; i < part.edges().size(); ++i) {
    const auto e = static_cast<Index>(i);
    copy(part.edge_vertices()[i], getBaseEdgeVertices(refiner, e));
    copy(part.edge_faces()[i], getBaseEdgeFaces(refiner, e));
    setBaseEdgeNonManifold(refiner, e, !part.is_manifold_edge(i));
  }
  for (std::size_t i = 0; i < part.vertices().size(); ++i) {
    const auto v = static_cast<Index>(i);
    copy(part.vertex_faces()[i], getBaseVertexFaces(refiner, v));
    copy(part.vertex_edges()[i], getBaseVertexEdges(refiner, v));
    setBaseVertexNonManifold(refiner, v, !part.is_manifold_vertex(i));
  }
  populateBaseLocalIndices(refiner);
  return true;
}

template <>
bool ExtractionFactory::assignComponentTags(TopologyRefiner& refiner,
                                            const taut::Extraction& part) {
  for (std::size_t f = 0; f < part.faces().size(); ++f) {
    if (part.is_hole(f)) setBaseFaceHole(refiner, static_cast<Index>(f), true);
  }
  for (std::size_t e = 0; e < part.edges().size(); ++e) {
    setBaseEdgeSharpness(refiner, static_cast<Index>(e), part.edge_sharpness(e));
  }
  for (std::size_t v = 0; v < part.vertices().size(); ++v) {
    setBaseVertexSharpness(refiner, static_cast<Index>(v), part.vertex_sharpness(v));
  }
  return true;
}
// NOLINTEND(readability-identifier-naming)

}  // namespace OpenSubdiv::OPENSUBDIV_VERSION::Far

namespace taut {
namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

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

template <class Faces>
std::unique_ptr<Far::TopologyRefiner> created(const Faces& faces, CageScheme scheme,
                                              const Sdc::Options& options) {
  static const bool silenced = [] {
    Far::SetErrorCallback(keep_error);
    Far::SetWarningCallback(pass_warning);
    return true;
  }();
  static_cast<void>(silenced);
  using Factory = Far::TopologyRefinerFactory<Faces>;
  last_error().clear();
  std::unique_ptr<Far::TopologyRefiner> refiner(
      Factory::Create(faces, typename Factory::Options(scheme_type(scheme), options)));
  if (!refiner) {
    throw BackendError("OpenSubdiv does not take the cage" +
                       (last_error().empty() ? std::string() : ": " + last_error()));
  }
  return refiner;
}

}  // namespace

std::unique_ptr<Far::TopologyRefiner> make_refiner(const Description& description,
                                                   CageScheme scheme, const Sdc::Options& options) {
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
  return created(d, scheme, options);
}

std::unique_ptr<Far::TopologyRefiner> make_refiner(const Extraction& extraction, CageScheme scheme,
                                                   const Sdc::Options& options) {
  return created(extraction, scheme, options);
}

}  // namespace taut
