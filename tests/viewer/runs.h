#pragma once

#include "meshes.h"

#include <pent/output_file.h>
#include <pent/pent_file.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pent::viewer::test {

/// Writes a run folder of one body as pent-sim does: a box that twists further with each frame,
/// 0.1 s apart, and moves along x at 2 m/s;
/// all of it `scale` times as large.
inline void write_run(const std::filesystem::path& run,
                      const std::string& body,
                      const std::vector<int>& frames,
                      double scale = 1) {
    SimplexMesh<4> mesh = jittered_box({2, 2, 2, 2}, 23);
    const Positions<4> start = mesh.positions;
    mesh.positions *= scale;
    make_folder(run / "meshes");
    make_folder(run / "frames");
    const std::uint32_t crc = write_mesh<4>(run / "meshes" / (body + ".pent"), mesh);
    for (const int number : frames) {
        Frame<4> frame;
        frame.positions = twisted(start, 0.1 * number);
        frame.positions.row(0).array() += 0.2 * number;
        frame.positions *= scale;
        frame.velocities = Positions<4>::Zero(4, mesh.vertex_count());
        frame.velocities.row(0).setConstant(2.0 * scale);
        frame.mesh_name = body + ".pent";
        frame.mesh_crc = crc;
        frame.frame = static_cast<std::uint64_t>(number);
        frame.step = frame.frame;
        frame.time = 0.1 * number;
        write_frame<4>(run / "frames" / frame_file_name(body, number), frame);
    }
}

}  // namespace pent::viewer::test
