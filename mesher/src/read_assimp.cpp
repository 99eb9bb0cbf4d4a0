#include "surface_readers.h"

#include <pent/error.h>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <vector>

namespace pent::mesher {

namespace {

// Points of all meshes one after the other; triangles only, other primitives are skipped.
TriangleSoup gather(const aiScene& scene) {
    Eigen::Index points = 0;
    Eigen::Index triangles = 0;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        points += mesh.mNumVertices;
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            triangles += mesh.mFaces[f].mNumIndices == 3 ? 1 : 0;
        }
    }
    TriangleSoup soup;
    soup.points.resize(3, points);
    soup.triangles.resize(3, triangles);
    std::uint32_t point = 0;
    Eigen::Index triangle = 0;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices == 3) {
                soup.triangles.col(triangle++) << point + face.mIndices[0],
                    point + face.mIndices[1], point + face.mIndices[2];
            }
        }
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D& p = mesh.mVertices[v];
            soup.points.col(point++) << double{p.x}, double{p.y}, double{p.z};
        }
    }
    return soup;
}

}  // namespace

TriangleSoup read_with_assimp(const std::filesystem::path& path) {
    Assimp::Importer importer;
    const aiScene* scene =
        importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_PreTransformVertices);
    if (scene == nullptr) {
        throw Error(path.string() + ": cannot be read as a surface: " + importer.GetErrorString());
    }
    TriangleSoup soup = gather(*scene);
    for (Eigen::Index i = 0; i < soup.points.cols(); ++i) {
        if (!soup.points.col(i).allFinite()) {
            throw Error(path.string() + ": point " + std::to_string(i)
                        + ": a coordinate is not finite");
        }
    }
    if (soup.triangles.size() > 0 && soup.triangles.maxCoeff() >= soup.points.cols()) {
        throw Error(path.string() + ": a triangle has corner "
                    + std::to_string(soup.triangles.maxCoeff()) + " of "
                    + std::to_string(soup.points.cols()) + " points");
    }
    return soup;
}

}  // namespace pent::mesher
