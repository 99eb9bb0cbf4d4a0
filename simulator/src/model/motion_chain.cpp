#include "model/motion_chain.h"

#include <pent/dimensions.h>

namespace pent::simulator {

template <int Dim>
std::vector<CenteredMotion<Dim>> center(const std::vector<Motion>& motions,
                                        const Vector<Dim>& middle) {
    std::vector<CenteredMotion<Dim>> centered;
    for (const Motion& motion : motions) {
        Vector<Dim> about = middle;
        if (motion.about) {
            about = *motion.about;
        } else {
            MotionChain<Dim>(centered, motion.from).move(about, nullptr);
        }
        centered.push_back({motion, about});
    }
    return centered;
}

template <int Dim>
MotionChain<Dim>::MotionChain(const std::vector<CenteredMotion<Dim>>& motions, double time) {
    for (const CenteredMotion<Dim>& centered : motions) {
        links_.push_back({pose_at<Dim>(centered.motion, time), centered.about});
    }
}

template <int Dim>
void MotionChain<Dim>::move(Vector<Dim>& point, Vector<Dim>* velocity) const {
    for (const auto& [pose, about] : links_) {
        const Vector<Dim> arm = point - about;
        // Written as a change of the position, which a motion at rest keeps to the bit.
        point += (pose.rotation - Matrix<Dim>::Identity()) * arm + pose.shift;
        if (velocity != nullptr) {
            *velocity = (pose.rotation * *velocity + pose.rate * arm + pose.velocity).eval();
        }
    }
}

template <int Dim>
Matrix<Dim> MotionChain<Dim>::rotation() const {
    Matrix<Dim> rotation = Matrix<Dim>::Identity();
    for (const Link& link : links_) {
        rotation = (link.pose.rotation * rotation).eval();
    }
    return rotation;
}

#define PENT_INSTANTIATE(Dim)                                                         \
    template std::vector<CenteredMotion<Dim>> center<Dim>(const std::vector<Motion>&, \
                                                          const Vector<Dim>&);        \
    template class MotionChain<Dim>;
PENT_FOR_EACH_DIMENSION(PENT_INSTANTIATE)
#undef PENT_INSTANTIATE

}  // namespace pent::simulator
