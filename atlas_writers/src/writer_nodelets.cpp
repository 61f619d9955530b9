// SPDX-License-Identifier: MIT
// Nodelets: one per product. The only nodelets that open output files; the folder is the parameter `out` of
// the namespace.
#include <nodelet/nodelet.h>

#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/param_reader.hpp"
#include "atlas_ros/stage_link.hpp"
#include "writer_params.hpp"

namespace atlas_writers {

template <class Params>
class WriterNodelet : public nodelet::Nodelet {
 protected:
  virtual atlas::StageFactory bind(atlas_ros::StageLink& link, const Params& params,
                                   const std::string& out) = 0;

 private:
  void onInit() override try {
    atlas_ros::ParamReader reader(getPrivateNodeHandle());
    Params params;
    readParams(reader, params);
    reader.rejectUnread();
    std::string out;
    if (!getNodeHandle().getParam("out", out) || out.empty()) {
      throw std::invalid_argument("missing parameter " + getNodeHandle().resolveName("out") +
                                  " (the output folder)");
    }
    const std::string name = getName();
    link_ = std::make_unique<atlas_ros::StageLink>(getNodeHandle(), name.substr(name.rfind('/') + 1));
    link_->start(bind(*link_, params, out));
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    link_.reset();  // nodelet::Loader destroys a refused nodelet after its callback queues
    throw;          // the manager refuses the nodelet
  }

  std::unique_ptr<atlas_ros::StageLink> link_;
};

#define ATLAS_WRITER_NODELET(Name, bindCall)                                                \
  class Name##Nodelet : public WriterNodelet<atlas::Name##Params> {                         \
    atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::Name##Params& params, \
                             const std::string& out) override {                             \
      (void)params;                                                                         \
      return bindCall;                                                                      \
    }                                                                                       \
  }

ATLAS_WRITER_NODELET(TrajectoryWriter, atlas::bindTrajectoryWriter(link, out));
ATLAS_WRITER_NODELET(CloudWriter, atlas::bindCloudWriter(link, params, out));
ATLAS_WRITER_NODELET(MapWriter, atlas::bindMapWriter(link, params, out));
ATLAS_WRITER_NODELET(DepthWriter, atlas::bindDepthWriter(link, params, out));
ATLAS_WRITER_NODELET(FrustumWriter, atlas::bindFrustumWriter(link, params, out));
ATLAS_WRITER_NODELET(GridWriter, atlas::bindGridWriter(link, params, out));
ATLAS_WRITER_NODELET(ThermalWriter, atlas::bindThermalWriter(link, params, out));
ATLAS_WRITER_NODELET(ObstacleWriter, atlas::bindObstacleWriter(link, out));
ATLAS_WRITER_NODELET(LineWriter, atlas::bindLineWriter(link, params, out));
ATLAS_WRITER_NODELET(ObjectWriter, atlas::bindObjectWriter(link, out));
ATLAS_WRITER_NODELET(StatusWriter, atlas::bindStatusWriter(link, out));
ATLAS_WRITER_NODELET(TraceWriter, atlas::bindTraceWriter(link, out));
ATLAS_WRITER_NODELET(OverlayWriter, atlas::bindOverlayWriter(link, params, out));
#undef ATLAS_WRITER_NODELET

}  // namespace atlas_writers

PLUGINLIB_EXPORT_CLASS(atlas_writers::TrajectoryWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::CloudWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::MapWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::DepthWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::FrustumWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::GridWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::ThermalWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::ObstacleWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::LineWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::ObjectWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::StatusWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::TraceWriterNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(atlas_writers::OverlayWriterNodelet, nodelet::Nodelet)
