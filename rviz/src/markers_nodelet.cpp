// SPDX-License-Identifier: MIT
// Nodelet: results of the graph as markers of RViz. It only listens: it is no stage, says no hello and
// reports no progress, so a run neither waits for it nor depends on it.
#include <nodelet/nodelet.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <functional>
#include <pluginlib/class_list_macros.hpp>
#include <string>
#include <vector>

#include "atlas_ros/message_of.hpp"
#include "atlas_ros/param_reader.hpp"
#include "driven_path.hpp"
#include "markers.hpp"
#include "object_markers.hpp"

namespace atlas_rviz {
namespace {
/// Bounded, unlike those of the stages: a slow screen may skip, it must not grow.
constexpr int kQueue = 100;
constexpr atlas::Duration kVehicleStep =
    50 * atlas::kMillisecond;  // of event time; odometry comes at hundreds of Hz
}  // namespace

class MarkersNodelet : public nodelet::Nodelet {
  void onInit() override try {
    std::vector<std::string> cameras, radars, lidars;
    atlas_ros::ParamReader params(getPrivateNodeHandle());
    params.read("cameras", cameras);
    params.read("radars", radars);
    params.readOptional("lidars", lidars);
    params.read("vehicle_length_m", box_.length_m);
    params.read("vehicle_width_m", box_.width_m);
    params.read("vehicle_height_m", box_.height_m);
    params.read("vehicle_center_x_m", box_.center_x_m);
    params.read("vehicle_center_z_m", box_.center_z_m);
    params.rejectUnread();
    validate(box_);
    draw<atlas_msgs::ObstacleArray>("obstacles", "markers/obstacles", obstacleMarkers);
    for (const std::string& topic : {std::string("objects"), std::string("grid/objects")}) drawObjects(topic);
    for (const std::string& camera : cameras) {
      draw<atlas_msgs::FrustumArray>(camera + "/frustums", "markers/" + camera + "/frustums", frustumMarkers);
    }
    for (const std::string& radar : radars) {
      draw<atlas_msgs::RadarScan>(radar + "/scan", "markers/" + radar, radarMarkers);
    }
    for (const std::string& lidar : lidars) drawLines(lidar);
    anchor_publisher_ = advertise("markers/anchor", true);
    listen<sensor_msgs::NavSatFix>("geographic", [this](const sensor_msgs::NavSatFix& msg) {
      publish(anchor_publisher_, anchorMarkers(atlas_ros::anchorFromMsg(msg)));
    });
    vehicle_publisher_ = advertise("markers/vehicle", false);
    path_publisher_ = advertise("markers/path", true);
    listen<nav_msgs::Odometry>("odometry", [this](const nav_msgs::Odometry& msg) { onOdometry(msg); });
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    throw;  // the manager refuses the nodelet
  }

  /// Each message of `topic` becomes one array on `marker_topic`.
  template <class Message, class Markers>
  void draw(const std::string& topic, const std::string& marker_topic, Markers markers) {
    const ros::Publisher publisher = advertise(marker_topic, false);
    listen<Message>(topic, [publisher, markers](const Message& msg) {
      publish(publisher, markers(atlas_ros::fromMsg(msg)));
    });
  }

  void drawObjects(const std::string& topic) {
    const ros::Publisher publisher = advertise("markers/" + topic, false);
    listen<atlas_msgs::ObjectArray>(topic, [publisher](const atlas_msgs::ObjectArray& msg) {
      const auto objects = atlas_ros::fromMsg(msg);
      if (objects) publish(publisher, objectMarkers(**objects));
    });
  }

  void drawLines(const std::string& lidar) {
    const ros::Publisher publisher = advertise("markers/" + lidar + "/lines", false);
    listen<atlas_msgs::LineArray>(lidar + "/lines", [publisher](const atlas_msgs::LineArray& msg) {
      const auto lines = atlas_ros::fromMsg(msg);
      if (lines) publish(publisher, lineMarkers(*lines));
    });
  }

  template <class Message>
  void listen(const std::string& topic, std::function<void(const Message&)> onMessage) {
    subscribers_.push_back(getNodeHandle().subscribe<Message>(
        topic, kQueue,
        boost::function<void(const boost::shared_ptr<const Message>&)>(
            [onMessage](const boost::shared_ptr<const Message>& msg) { onMessage(*msg); })));
  }

  ros::Publisher advertise(const std::string& topic, bool latch) {
    return getNodeHandle().advertise<visualization_msgs::MarkerArray>(topic, kQueue, latch);
  }
  static void publish(const ros::Publisher& publisher, visualization_msgs::MarkerArray markers) {
    publisher.publish(boost::make_shared<visualization_msgs::MarkerArray>(std::move(markers)));
  }

  void onOdometry(const nav_msgs::Odometry& msg) {
    const auto odometry = atlas_ros::fromMsg(msg);
    if (!odometry) {
      NODELET_WARN_THROTTLE(10.0, "odometry that cannot be shown: %s", toString(odometry.reason()));
      return;
    }
    if (path_.add(*odometry)) publish(path_publisher_, pathMarkers(path_));
    const atlas::Duration since = odometry->stamp - vehicle_stamp_;
    if (vehicle_stamp_ != atlas::kBeginOfTime && since >= 0 && since < kVehicleStep) return;
    vehicle_stamp_ = odometry->stamp;
    publish(vehicle_publisher_, vehicleMarkers(*odometry, box_));
  }

  VehicleBox box_;
  DrivenPath path_;
  atlas::Stamp vehicle_stamp_ = atlas::kBeginOfTime;
  ros::Publisher vehicle_publisher_, path_publisher_, anchor_publisher_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace atlas_rviz

PLUGINLIB_EXPORT_CLASS(atlas_rviz::MarkersNodelet, nodelet::Nodelet)
