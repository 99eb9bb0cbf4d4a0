#include <pent/mesher/quantity_names.h>

namespace pent::mesher {

template <int Dim>
std::vector<std::string> quantity_names(const SimplexMesh<Dim>& mesh,
                                        const MeshExtras<Dim>& extras) {
    std::vector<std::string> names;
    for (const std::vector<VertexField>* fields : {&extras.vertex_fields, &extras.cell_fields}) {
        for (const VertexField& field : *fields) {
            names.push_back(field.name);
        }
    }
    if (mesh.fibers.cols() > 0) {
        names.emplace_back("fibers");
    }
    return names;
}

template std::vector<std::string> quantity_names<2>(const SimplexMesh<2>&, const MeshExtras<2>&);
template std::vector<std::string> quantity_names<3>(const SimplexMesh<3>&, const MeshExtras<3>&);
template std::vector<std::string> quantity_names<4>(const SimplexMesh<4>&, const MeshExtras<4>&);

}  // namespace pent::mesher
