#pragma once

#include <gtest/gtest.h>

#include <pent_plugin_meshes.h>

namespace pent::test {

/// Owns a mesh of the plugin.
class StoredMesh {
public:
    explicit StoredMesh(pent_stored_mesh* mesh) : mesh_(mesh) {
        EXPECT_NE(mesh, nullptr) << pent_last_error();
        EXPECT_EQ(pent_mesh_info_of(mesh, &info), 0) << pent_last_error();
    }
    ~StoredMesh() { EXPECT_EQ(pent_free_mesh(mesh_), 0); }
    StoredMesh(const StoredMesh&) = delete;
    StoredMesh(StoredMesh&&) = delete;
    StoredMesh& operator=(const StoredMesh&) = delete;
    StoredMesh& operator=(StoredMesh&&) = delete;

    // NOLINTNEXTLINE(google-explicit-constructor): stands for it
    operator pent_stored_mesh*() const { return mesh_; }
    pent_mesh_info info = {};

private:
    pent_stored_mesh* mesh_;
};

}  // namespace pent::test
