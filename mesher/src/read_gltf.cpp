#include "isolated.h"
#include "surface_readers.h"

#include <pent/error.h>

#include <Eigen/Geometry>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <string>
#include <utility>

namespace pent::mesher {

namespace {

Eigen::Affine3d placement(const aiMatrix4x4& m) {
    Eigen::Affine3d result;
    result.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1,
        m.d2, m.d3, m.d4;
    return result;
}

void add_mesh(const aiMesh& mesh,
              const Eigen::Affine3d& place,
              const std::string& name,
              SoupBuilder& builder) {
    const auto first = static_cast<std::uint32_t>(builder.point_count());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        const aiVector3D& p = mesh.mVertices[v];
        const Eigen::Vector3d point = place * Eigen::Vector3d(p.x, p.y, p.z);
        if (!point.allFinite()) {
            throw Error(name + ": point " + std::to_string(v) + " is not finite");
        }
        builder.add_point(point);
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        std::vector<std::uint32_t> polygon;
        for (unsigned i = 0; i < face.mNumIndices; ++i) {
            if (face.mIndices[i] >= mesh.mNumVertices) {
                // GCOVR_EXCL_START: assimp leaves such faces out; whether every release does?
                throw Error(name + ": face " + std::to_string(f) + " has corner "
                            + std::to_string(face.mIndices[i]) + " of "
                            + std::to_string(mesh.mNumVertices));
                // GCOVR_EXCL_STOP
            }
            polygon.push_back(first + face.mIndices[i]);
        }
        if (polygon.size() >= 3) {
            builder.add_polygon(polygon);
        } else {
            builder.leave_out(polygon.size() == 2 ? CellKind::Line : CellKind::Point);
        }
    }
}

void add_node(const aiScene& scene,
              const aiNode& node,
              const Eigen::Affine3d& above,
              const std::string& name,
              SoupBuilder& builder) {
    const Eigen::Affine3d place = above * placement(node.mTransformation);
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        add_mesh(*scene.mMeshes[node.mMeshes[m]], place, name, builder);
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c) {
        add_node(scene, *node.mChildren[c], place, name, builder);
    }
}

TriangleSoup import_by_assimp(const std::filesystem::path& path) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path.string(), aiProcess_ValidateDataStructure);
    if (scene == nullptr || scene->mRootNode == nullptr) {
        throw Error(path.string() + ": cannot be read as glTF: " + importer.GetErrorString());
    }
    SoupBuilder builder;
    add_node(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), path.string(), builder);
    return builder.soup();
}

}  // namespace

TriangleSoup read_gltf(const std::filesystem::path& path, const StepLimits& limits) {
    // Debian's assimp has its asserts on, and a damaged scene ends the process.
    Pieces<3> pieces =
        run_isolated<3>(path.string() + ": reading it by assimp", limits, [&]() -> Pieces<3> {
            TriangleSoup soup = import_by_assimp(path);
            return {std::move(soup.points), std::move(soup.triangles), soup.left_out};
        });
    return {std::move(pieces.points), std::move(pieces.cells), pieces.left_out};
}

}  // namespace pent::mesher
