#ifndef POISE_CORE_MOTION_IO_CONVENTION_DETECTION_H_
#define POISE_CORE_MOTION_IO_CONVENTION_DETECTION_H_

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/motion/io/raw_clip.h"

namespace poise::motion {

/// A body's height as its bones tell it, whatever its pose: the longest way along bones from one
/// tip to another (a foot to the other side's fingers), divided by what it is to a human's height.
/// Unit: that of the offsets.
double BodyHeight(std::span<const Joint> joints);

/// Length of one file unit [m]: metres, centimetres or millimetres if one gives a human body, else
/// whichever comes nearest to one, inches and the 0.056444 m of CMU's and HDM05's recordings
/// included.
RawClip::Stated<double> DetectUnit(std::span<const Joint> joints);

/// The axis along which the body stands through the motion (head over ankles) and along which its
/// lowest joint keeps its height, since people come back to the floor.
RawClip::Stated<UpAxis> DetectUpAxis(const RawClip& raw);

/// Whether the unposed skeleton stands along Z.
bool RestPoseStandsAlongZ(const std::vector<Joint>& joints);

/// Frame rate [Hz] that was written as a frame time of `seconds` in the text `written`: a usual or
/// whole rate that rounds to the same digits ("0.0333333" is 30 Hz), else 1 / seconds.
double RateOfFrameTime(double seconds, std::string_view written);

}  // namespace poise::motion

#endif  // POISE_CORE_MOTION_IO_CONVENTION_DETECTION_H_
