#include "taut/containment/triangle_rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "taut/core/error.h"
#include "taut/core/tolerances.h"

namespace taut {
namespace {

constexpr float ray_end = std::numeric_limits<float>::infinity();

/// What a distance within a box of size one is off by at most when it is found in floats (measured
/// 3e-6 at ten times the box's size).
constexpr double float_rounding = 1e-5;

/// Nearer to a side than this share of a triangle, hits are doubtful (with random rays none is
/// wrong for a thousandth; see the tests).
constexpr float doubtful_share = 1e-3F;

/// Hits of a triangle whose normal is nearer to the plane across the ray than this, as a cosine,
/// are doubtful.
constexpr float doubtful_cosine = 1e-3F;

template <auto Release>
struct Releaser {
  template <class Handle>
  void operator()(Handle* handle) const {
    Release(handle);
  }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Releaser<rtcReleaseDevice>>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Releaser<rtcReleaseGeometry>>;
using EmbreeScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Releaser<rtcReleaseScene>>;

const char* name_of(RTCError error) {
  switch (error) {
    case RTC_ERROR_NONE:
      return "no error";
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "unsupported processor";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    default:
      return "unknown error";
  }
}

/// @throws BackendError if Embree has failed since the last look
void check(RTCDevice device, const char* step) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw LimitExceeded("Embree: out of memory");
  if (error != RTC_ERROR_NONE) {
    throw BackendError(std::string("Embree: ") + step + ": " + name_of(error));
  }
}

RTCRay ray(const dvec3& origin, const dvec3& direction) {
  RTCRay r{};
  r.org_x = float(origin.x);
  r.org_y = float(origin.y);
  r.org_z = float(origin.z);
  r.dir_x = float(direction.x);
  r.dir_y = float(direction.y);
  r.dir_z = float(direction.z);
  r.tfar = ray_end;
  r.mask = ~0U;
  return r;
}

/// Embree's context with what the filter collects.
struct Collector {
  RTCIntersectContext context;
  TriangleRays::Hits* hits;
};

/// Notes a hit and has Embree go on as if there was none.
void collect(const RTCFilterFunctionNArguments* arguments) {
  auto* collector = reinterpret_cast<Collector*>(arguments->context);  // its first member
  RTCHitN* hit = arguments->hit;
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const float u = RTCHitN_u(hit, arguments->N, i);
    const float v = RTCHitN_v(hit, arguments->N, i);
    const float ng[3] = {RTCHitN_Ng_x(hit, arguments->N, i), RTCHitN_Ng_y(hit, arguments->N, i),
                         RTCHitN_Ng_z(hit, arguments->N, i)};
    const float d[3] = {RTCRayN_dir_x(arguments->ray, arguments->N, i),
                        RTCRayN_dir_y(arguments->ray, arguments->N, i),
                        RTCRayN_dir_z(arguments->ray, arguments->N, i)};
    const float along = ng[0] * d[0] + ng[1] * d[1] + ng[2] * d[2];
    const float length = std::sqrt(ng[0] * ng[0] + ng[1] * ng[1] + ng[2] * ng[2]);
    if (!(std::min({u, v, 1 - u - v}) > doubtful_share) ||
        !(std::abs(along) > doubtful_cosine * length)) {
      collector->hits->doubtful = true;
    }
    collector->hits->triangles.push_back(int(RTCHitN_primID(hit, arguments->N, i)));
    arguments->valid[i] = 0;
  }
}

struct NearestQuery {
  const std::function<double(int)>* distance;
  double nearest;
  double scale;
  double rounding;  ///< of Embree's distances
};

bool visit_near(RTCPointQueryFunctionArguments* arguments) {
  auto* query = static_cast<NearestQuery*>(arguments->userPtr);
  const double d = (*query->distance)(int(arguments->primID));
  if (!(d < query->nearest)) return false;
  query->nearest = d;
  arguments->query->radius = float(d * query->scale + query->rounding);
  return true;
}

}  // namespace

struct TriangleRays::Embree {
  Device device;
  EmbreeScene scene;
  dvec3 center;
  double scale;

  dvec3 normalised(const dvec3& x) const { return (x - center) * scale; }
};

TriangleRays::TriangleRays(std::span<const dvec3> points, std::span<const Triangle> triangles)
    : embree_(std::make_unique<Embree>()) {
  Box box;
  for (const dvec3& p : points) box.include(p);
  embree_->center = box.center();
  const dvec3 half = 0.5 * box.upper - 0.5 * box.lower;
  const double size = std::max({half.x, half.y, half.z});
  embree_->scale = size > 0 ? 1 / size : 1;

  // Threads are ours to start (core/parallel).
  embree_->device.reset(rtcNewDevice("threads=1"));
  if (!embree_->device) check(nullptr, "no device");
  RTCDevice device = embree_->device.get();
  const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  check(device, "no geometry");
  auto* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              3 * sizeof(float), points.size()));
  auto* indices = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), triangles.size()));
  check(device, "buffers");
  for (const dvec3& p : points) {
    const dvec3 x = embree_->normalised(p);
    for (int axis = 0; axis < 3; ++axis) *vertices++ = float(x[axis]);
  }
  for (const Triangle& triangle : triangles) {
    for (const int v : triangle) *indices++ = unsigned(v);
  }
  rtcCommitGeometry(geometry.get());
  embree_->scene.reset(rtcNewScene(device));
  check(device, "geometry");
  RTCScene scene = embree_->scene.get();
  // Robust: no ray passes between two triangles that share a side.
  rtcSetSceneFlags(scene,
                   RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
  rtcAttachGeometry(scene, geometry.get());
  rtcCommitScene(scene);
  check(device, "scene");
}

TriangleRays::~TriangleRays() = default;
TriangleRays::TriangleRays(TriangleRays&&) noexcept = default;
TriangleRays& TriangleRays::operator=(TriangleRays&&) noexcept = default;

int TriangleRays::first_hit(const dvec3& origin, const dvec3& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit hit{};
  hit.ray = ray(embree_->normalised(origin), direction);
  hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(embree_->scene.get(), &context, &hit);
  return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1 : int(hit.hit.primID);
}

void TriangleRays::all_hits(const dvec3& origin, const dvec3& direction, Hits& hits) const {
  hits.triangles.clear();
  hits.doubtful = false;
  Collector collector{};
  rtcInitIntersectContext(&collector.context);
  collector.context.filter = collect;
  collector.hits = &hits;
  RTCRay r = ray(embree_->normalised(origin), direction);
  rtcOccluded1(embree_->scene.get(), &collector.context, &r);
  // Spatial splits report a triangle more than once.
  std::sort(hits.triangles.begin(), hits.triangles.end());
  hits.triangles.erase(std::unique(hits.triangles.begin(), hits.triangles.end()),
                       hits.triangles.end());
}

double TriangleRays::nearest(const dvec3& x, double radius,
                             const std::function<double(int triangle)>& distance) const {
  const dvec3 at = embree_->normalised(x);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  // Far away floats are coarser.
  const double rounding = float_rounding * std::max(1.0, glm::length(at));
  NearestQuery user{&distance, radius, embree_->scale, rounding};
  RTCPointQuery query{};
  query.x = float(at.x);
  query.y = float(at.y);
  query.z = float(at.z);
  query.radius = float(radius * embree_->scale + rounding);
  rtcPointQuery(embree_->scene.get(), &query, &context, visit_near, &user);
  return user.nearest;
}

}  // namespace taut
