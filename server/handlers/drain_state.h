#ifndef POISE_SERVER_HANDLERS_DRAIN_STATE_H_
#define POISE_SERVER_HANDLERS_DRAIN_STATE_H_

#include <atomic>

namespace poise::server {

/// How far the end of the server has come, for calls that wait. Whoever sets one of them wakes
/// those calls afterwards.
struct DrainState {
  std::atomic<bool> announced = false;  ///< calls are served, but no job is leased any more
  std::atomic<bool> ending = false;     ///< whoever waits is sent away
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_DRAIN_STATE_H_
