#pragma once

#include <pent/exchange/exchange.h>

namespace pent::exchange {

/// Readers and writers of one format each; what is written is what the format holds.

[[nodiscard]] Content read_pent(const std::filesystem::path& path);
void write_pent(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options);

/// [stella4d, miratope]: points, polygons on points, cells on polygons.
[[nodiscard]] Content read_4off(const std::filesystem::path& path);
void write_4off(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options);

/// [g4mf]: JSON with buffers, in text or in chunks.
[[nodiscard]] Content read_g4mf(const std::filesystem::path& path);
void write_g4mf(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options);

/// [4do]: `v` and `t` lines, 0-based.
[[nodiscard]] Content read_4do(const std::filesystem::path& path);
void write_4do(const std::filesystem::path& path,
               const Content& content,
               const WriteOptions& options);

/// [tesserxel]: an OBJ whose points have four coordinates and whose `t` lines have four corners.
[[nodiscard]] Content read_4obj(const std::filesystem::path& path);
void write_4obj(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options);

/// [mfem4d]: pentatopes and the tetrahedra of the boundary, each with a label.
[[nodiscard]] Content read_mfem(const std::filesystem::path& path);
void write_mfem(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options);

/// The boundary in x, y and z, with w as a quantity of its points: a view, from which the body
/// cannot be read again.
void write_legacy_vtk(const std::filesystem::path& path,
                      const Content& content,
                      const WriteOptions& options);
void write_gmsh(const std::filesystem::path& path,
                const Content& content,
                const WriteOptions& options);

}  // namespace pent::exchange
