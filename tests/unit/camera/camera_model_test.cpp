// SPDX-License-Identifier: MIT
#include "atlas/camera/camera_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "scene.hpp"

namespace atlas::test {
namespace {

CameraModel modelOf(const CameraInfo& info) { return CameraModel::fromInfo(info).value(); }

TEST(CameraModel, projectsByHandWithoutDistortion) {
  const CameraModel model = modelOf(simpleInfo());
  // u = 100 * 1/10 + 50, v = 100 * -2/10 + 40
  const auto pixel = model.project({1.0, -2.0, 10.0});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 60.0, 1e-12);
  EXPECT_NEAR(pixel->y(), 20.0, 1e-12);
}

TEST(CameraModel, plumbBobAgreesWithOpenCv) {
  for (const CameraInfo& info : budCameras()) {
    const CameraModel model = modelOf(info);
    const cv::Matx33d K(info.K.data());
    for (double x = -0.6; x <= 0.6; x += 0.2) {
      for (double y = -0.5; y <= 0.5; y += 0.1) {
        std::vector<cv::Point2d> expected;
        cv::projectPoints(std::vector<cv::Point3d>{{7 * x, 7 * y, 7.0}}, cv::Vec3d(), cv::Vec3d(), K,
                          info.distortion, expected);
        const auto pixel = model.project({7 * x, 7 * y, 7.0});
        ASSERT_TRUE(pixel) << info.frame;
        EXPECT_NEAR(pixel->x(), expected[0].x, 1e-9) << info.frame;
        EXPECT_NEAR(pixel->y(), expected[0].y, 1e-9) << info.frame;
      }
    }
  }
}

TEST(CameraModel, rationalAndFisheyeAgreeWithOpenCv) {
  CameraInfo rational = leftFrontInfo();
  rational.distortion_model = "rational_polynomial";
  rational.distortion = {0.41, -0.12, 0.0003, -0.0002, 0.01, 0.55, -0.08, 0.002};
  CameraInfo fisheye = leftFrontInfo();
  fisheye.distortion_model = "equidistant";
  fisheye.distortion = {-0.021, 0.004, -0.0017, 0.0002};
  const cv::Matx33d K(rational.K.data());
  const CameraModel rational_model = modelOf(rational), fisheye_model = modelOf(fisheye);
  for (double x = -0.9; x <= 0.9; x += 0.3) {
    const cv::Point3d p(x * 4, 0.3 * 4, 4.0);
    std::vector<cv::Point2d> expected;
    cv::projectPoints(std::vector<cv::Point3d>{p}, cv::Vec3d(), cv::Vec3d(), K, rational.distortion,
                      expected);
    const auto pixel = rational_model.project({p.x, p.y, p.z});
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x(), expected[0].x, 1e-9);
    EXPECT_NEAR(pixel->y(), expected[0].y, 1e-9);
    cv::fisheye::projectPoints(std::vector<cv::Point3d>{p}, expected, cv::Vec3d(), cv::Vec3d(), K,
                               fisheye.distortion);
    const auto fisheye_pixel = fisheye_model.project({p.x, p.y, p.z});
    ASSERT_TRUE(fisheye_pixel);
    EXPECT_NEAR(fisheye_pixel->x(), expected[0].x, 1e-9);
    EXPECT_NEAR(fisheye_pixel->y(), expected[0].y, 1e-9);
    const auto bearing = fisheye_model.bearing(*fisheye_pixel);
    ASSERT_TRUE(bearing);
    EXPECT_NEAR(bearing->x(), x, 1e-9);
  }
}

// W14: the bearing undoes the distortion; without that the corners are off by up to 2.25 deg.
TEST(CameraModel, W14_bearingIsTheInverseOfProjectionOverTheWholeImage) {
  for (const CameraInfo& info : budCameras()) {
    const CameraModel model = modelOf(info);
    for (double u = -0.5; u <= model.width(); u += model.width() / 48.0) {
      for (double v = -0.5; v <= model.height(); v += model.height() / 32.0) {
        const auto bearing = model.bearing({u, v});
        ASSERT_TRUE(bearing) << info.frame << " " << u << " " << v;
        EXPECT_EQ(bearing->z(), 1.0);
        const auto pixel = model.project(*bearing * 17.0);
        ASSERT_TRUE(pixel) << info.frame << " " << u << " " << v;
        EXPECT_NEAR(pixel->x(), u, 1e-6) << info.frame;
        EXPECT_NEAR(pixel->y(), v, 1e-6) << info.frame;
      }
    }
  }
}

TEST(CameraModel, W14_bearingOfACornerDiffersFromThePinholeByDegrees) {
  const CameraModel model = modelOf(irInfo());
  const Eigen::Vector3d bearing = model.bearing({0.0, 0.0}).value();
  const Eigen::Vector3d pinhole((0.0 - model.cx()) / model.fx(), (0.0 - model.cy()) / model.fy(), 1.0);
  const double angle_deg = std::acos(bearing.normalized().dot(pinhole.normalized())) * 180.0 / M_PI;
  EXPECT_GT(angle_deg, 2.0);
  EXPECT_LT(angle_deg, 8.0);
}

// W15: beyond the angle at which the distorted radius is largest, points would come back into the image.
TEST(CameraModel, W15_pointsBeyondTheFoldAreNotInTheImage) {
  for (const CameraInfo& info : budCameras()) {
    const CameraModel model = modelOf(info);
    const double fold_deg = std::atan(model.maxTangent()) * 180.0 / M_PI;
    EXPECT_LT(fold_deg, 75.0) << info.frame;
    for (double angle = 0.05; angle < 89.9; angle += 0.05) {
      for (int direction = 0; direction < 16; ++direction) {
        const double r = std::tan(angle * M_PI / 180.0), a = 2.0 * M_PI * direction / 16.0;
        const auto pixel = model.project({r * std::cos(a), r * std::sin(a), 1.0});
        if (angle > fold_deg) {
          EXPECT_FALSE(pixel) << info.frame << " " << angle;
        }
        // What is in the image lies within the field that the border's bearings span: half the diagonal, 51
        // deg.
        if (pixel && model.inImage(*pixel)) {
          EXPECT_LT(angle, 55.0) << info.frame;
        }
      }
    }
  }
}

TEST(CameraModel, W15_foldIsWhereTheRadiusStopsGrowing) {
  CameraInfo info = simpleInfo();
  info.distortion = {-0.3, 0.0, 0.0, 0.0, 0.0};
  // d/dr (r - 0.3 r^3) = 1 - 0.9 r^2 = 0
  EXPECT_NEAR(modelOf(info).maxTangent(), std::sqrt(1.0 / 0.9), 1e-9);
  const CameraModel model = modelOf(info);
  EXPECT_TRUE(model.project({1.054, 0.0, 1.0}));
  EXPECT_FALSE(model.project({1.055, 0.0, 1.0}));
  // Largest radius reached: 1.0541 * (1 - 1/3) = 0.7027; a pixel beyond it has no bearing.
  EXPECT_TRUE(model.bearing({50.0 + 70.2, 40.0}));
  EXPECT_FALSE(model.bearing({50.0 + 70.4, 40.0}));
}

TEST(CameraModel, nothingBehindTheCamera) {
  const CameraModel model = modelOf(simpleInfo());
  EXPECT_FALSE(model.project({0.0, 0.0, -5.0}));
  EXPECT_FALSE(model.project({0.0, 0.0, 0.0}));
  EXPECT_FALSE(model.project({std::nan(""), 0.0, 5.0}));
  EXPECT_FALSE(model.project({0.0, 0.0, std::nan("")}));
  EXPECT_FALSE(model.bearing({std::nan(""), 0.0}));
}

TEST(CameraModel, imageEndsHalfAPixelAroundTheOuterCentres) {
  const CameraModel model = modelOf(simpleInfo());
  EXPECT_TRUE(model.inImage({-0.5, -0.5}));
  EXPECT_FALSE(model.inImage({-0.51, 0.0}));
  EXPECT_TRUE(model.inImage({100.49, 80.49}));
  EXPECT_FALSE(model.inImage({100.5, 0.0}));
}

TEST(CameraModel, refusesWhatItDoesNotKnow) {
  const auto reasonOf = [](const std::function<void(CameraInfo&)>& change) {
    CameraInfo info = leftFrontInfo();
    change(info);
    const auto model = CameraModel::fromInfo(info);
    EXPECT_FALSE(model);
    return model.reason();
  };
  EXPECT_EQ(reasonOf([](CameraInfo& i) { i.K = {}; }), Reason::kMissingIntrinsics);
  EXPECT_EQ(reasonOf([](CameraInfo& i) { i.width = 0; }), Reason::kMissingIntrinsics);
  EXPECT_EQ(reasonOf([](CameraInfo& i) { i.distortion_model = "sphere"; }), Reason::kBadLayout);
  EXPECT_EQ(reasonOf([](CameraInfo& i) { i.distortion.pop_back(), i.distortion.pop_back(); }),
            Reason::kBadLayout);
  EXPECT_EQ(reasonOf([](CameraInfo& i) { i.K[1] = 0.5; }), Reason::kBadLayout);
  EXPECT_EQ(reasonOf([](CameraInfo& i) { i.width = 4'000'000'000U; }), Reason::kBadLayout);
  EXPECT_EQ(reasonOf([](CameraInfo& i) { i.distortion[0] = std::numeric_limits<double>::quiet_NaN(); }),
            Reason::kNotFinite);
}

}  // namespace
}  // namespace atlas::test
