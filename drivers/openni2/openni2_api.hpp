// The calls of libOpenNI2 that this driver makes, as a table, so that tests can make each of them fail.
#pragma once

#include <OniCAPI.h>
#include <OniCProperties.h>

namespace pliant {

struct OpenNi2Api {
  decltype(&oniInitialize) initialize = &oniInitialize;
  decltype(&oniShutdown) shutdown = &oniShutdown;
  decltype(&oniGetDeviceList) get_device_list = &oniGetDeviceList;
  decltype(&oniReleaseDeviceList) release_device_list = &oniReleaseDeviceList;
  decltype(&oniRegisterDeviceCallbacks) register_callbacks = &oniRegisterDeviceCallbacks;
  decltype(&oniUnregisterDeviceCallbacks) unregister_callbacks = &oniUnregisterDeviceCallbacks;
  decltype(&oniGetExtendedError) extended_error = &oniGetExtendedError;
  decltype(&oniDeviceOpen) device_open = &oniDeviceOpen;
  decltype(&oniDeviceClose) device_close = &oniDeviceClose;
  decltype(&oniDeviceGetSensorInfo) device_sensor_info = &oniDeviceGetSensorInfo;
  decltype(&oniDeviceSetProperty) device_set = &oniDeviceSetProperty;
  decltype(&oniDeviceGetProperty) device_get = &oniDeviceGetProperty;
  decltype(&oniDeviceIsPropertySupported) device_has = &oniDeviceIsPropertySupported;
  decltype(&oniDeviceCreateStream) create_stream = &oniDeviceCreateStream;
  decltype(&oniStreamDestroy) stream_destroy = &oniStreamDestroy;
  decltype(&oniStreamStart) stream_start = &oniStreamStart;
  decltype(&oniStreamStop) stream_stop = &oniStreamStop;
  decltype(&oniStreamSetProperty) stream_set = &oniStreamSetProperty;
  decltype(&oniStreamGetProperty) stream_get = &oniStreamGetProperty;
  decltype(&oniStreamIsPropertySupported) stream_has = &oniStreamIsPropertySupported;
  decltype(&oniWaitForAnyStream) wait_for_any_stream = &oniWaitForAnyStream;
  decltype(&oniStreamReadFrame) read_frame = &oniStreamReadFrame;
  decltype(&oniFrameRelease) frame_release = &oniFrameRelease;
};

}  // namespace pliant
