#include "ray_scene.h"

#include <pent/error.h>

namespace pent::viewer {

RayScene::RayScene(RTCDevice device,
                   std::span<const RenderObject> objects,
                   bool ghosts,
                   const RaySpace& space)
    : objects_(objects), vertices_(objects.size()), scene_(rtcNewScene(device)) {
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const RenderObject& object = objects[i];
        if ((object.opacity < 1) != ghosts || object.triangles.cols() == 0) {
            continue;
        }
        is_empty_ = false;
        vertices_[i].resize(4, object.positions.cols());
        vertices_[i].topRows<3>() =
            ((object.positions.colwise() - space.origin) / space.unit).cast<float>();
        vertices_[i].row(3).setZero();
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   vertices_[i].data(), 0, 4 * sizeof(float),
                                   static_cast<std::size_t>(object.positions.cols()));
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   object.triangles.data(), 0, 3 * sizeof(std::uint32_t),
                                   static_cast<std::size_t>(object.triangles.cols()));
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene_.get(), geometry, static_cast<unsigned>(i));
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_.get());
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
        // GCOVR_EXCL_START: short memory
        throw Error("picture: the ray tracer could not take the surfaces; is memory short?");
        // GCOVR_EXCL_STOP
    }
}

RayHit RayScene::first_hit(const Vec& from, const Vec& direction, float nearest) const {
    RTCIntersectContext context{};
    rtcInitIntersectContext(&context);
    RTCRayHit query = {};
    query.ray.org_x = from.x();
    query.ray.org_y = from.y();
    query.ray.org_z = from.z();
    query.ray.dir_x = direction.x();
    query.ray.dir_y = direction.y();
    query.ray.dir_z = direction.z();
    query.ray.tnear = nearest;
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0U;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context, &query);
    RayHit hit;
    if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
        hit.distance = query.ray.tfar;
        hit.object = query.hit.geomID;
        hit.triangle = query.hit.primID;
        hit.u = query.hit.u;
        hit.v = query.hit.v;
        hit.normal = Vec(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).stableNormalized();
    }
    return hit;
}

unsigned RayScene::blocked(const Bundle& bundle) const {
    RTCIntersectContext context{};
    rtcInitIntersectContext(&context);
    alignas(32) std::array<int, Bundle::kRays> valid{};  // -1 for a ray that is there
    RTCRay8 rays = {};
    for (int k = 0; k < bundle.count; ++k) {
        valid[k] = -1;
        rays.org_x[k] = bundle.from.x();
        rays.org_y[k] = bundle.from.y();
        rays.org_z[k] = bundle.from.z();
        rays.dir_x[k] = bundle.directions[k].x();
        rays.dir_y[k] = bundle.directions[k].y();
        rays.dir_z[k] = bundle.directions[k].z();
        rays.tfar[k] = bundle.farthest[k];
        rays.mask[k] = ~0U;
    }
    rtcOccluded8(valid.data(), scene_.get(), &context, &rays);
    unsigned blocked = 0;
    for (int k = 0; k < bundle.count; ++k) {
        blocked |=
            rays.tfar[k] < 0 ? 1U << k : 0U;  // what Embree sets for a ray that meets something
    }
    return blocked;
}

Vec RayScene::corner(const RayHit& hit, int k) const {
    const std::uint32_t vertex = objects_[hit.object].triangles(k, hit.triangle);
    return vertices_[hit.object].col(vertex).head<3>();
}

Vec RayScene::corner_normal(const RayHit& hit, int k) const {
    const Eigen::Index column = 3 * static_cast<Eigen::Index>(hit.triangle) + k;
    return objects_[hit.object].normals.col(column).cast<float>();
}

Vec RayScene::smooth_normal(const RayHit& hit) const {
    const Vec mixed = (1 - hit.u - hit.v) * corner_normal(hit, 0) + hit.u * corner_normal(hit, 1)
                      + hit.v * corner_normal(hit, 2);
    const float length = mixed.norm();
    return length > 0 ? Vec(mixed / length) : hit.normal;
}

Color RayScene::color(const RayHit& hit) const {
    const RenderObject& object = objects_[hit.object];
    const auto at = [&](int k) { return object.colors.col(object.triangles(k, hit.triangle)); };
    return (1 - hit.u - hit.v) * at(0) + hit.u * at(1) + hit.v * at(2);
}

}  // namespace pent::viewer
