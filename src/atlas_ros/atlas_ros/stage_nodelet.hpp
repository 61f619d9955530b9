// SPDX-License-Identifier: MIT
// What all stage nodelets share: strict parameters, then the stage's own wiring (atlas/pipeline.hpp) bound to
// topics.
#pragma once

#include <nodelet/nodelet.h>

#include <memory>
#include <string>

#include "atlas_ros/param_reader.hpp"
#include "atlas_ros/stage_link.hpp"
#include "atlas_ros/stage_params.hpp"

namespace atlas_ros {

template <class Params>
class StageNodelet : public nodelet::Nodelet {
 protected:
  /// Declares inputs and outputs on the link; gives the factory of the stage. May throw, but only before it
  /// advertises anything of its own: a refused nodelet outlives its callback queues.
  virtual atlas::StageFactory bind(StageLink& link, const Params& params) = 0;

 private:
  void onInit() override try {
    ParamReader reader(getPrivateNodeHandle());
    Params params;
    readParams(reader, params);
    reader.rejectUnread();
    const std::string name = getName();
    link_ = std::make_unique<StageLink>(getNodeHandle(), name.substr(name.rfind('/') + 1));
    link_->start(bind(*link_, params));
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    link_.reset();  // nodelet::Loader destroys a refused nodelet after its callback queues
    throw;          // the manager refuses the nodelet
  }

  std::unique_ptr<StageLink> link_;
};

}  // namespace atlas_ros
