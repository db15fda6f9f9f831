// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0

// Serves what a pipeline makes as rtsp://127.0.0.1:PORT/stream, and goes away after some seconds:
//
//   rtsp_server SECONDS PORT PIPELINE      the payloader is called pay0; PORT 0: any; prints the
//   port

#include <cstdio>
#include <cstdlib>

#include <gst/gst.h>
#include <gst/rtsp-server/rtsp-server.h>

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: rtsp_server SECONDS PORT PIPELINE\n", stderr);
    return 2;
  }
  gst_init(nullptr, nullptr);
  GMainLoop* loop = g_main_loop_new(nullptr, FALSE);
  GstRTSPServer* server = gst_rtsp_server_new();
  gst_rtsp_server_set_address(server, "127.0.0.1");
  gst_rtsp_server_set_service(server, argv[2]);
  GstRTSPMediaFactory* factory = gst_rtsp_media_factory_new();
  gst_rtsp_media_factory_set_launch(factory, argv[3]);
  GstRTSPMountPoints* mounts = gst_rtsp_server_get_mount_points(server);
  gst_rtsp_mount_points_add_factory(mounts, "/stream", factory);
  g_object_unref(mounts);
  if (gst_rtsp_server_attach(server, nullptr) == 0) return 1;
  std::printf("%d\n", gst_rtsp_server_get_bound_port(server));
  std::fflush(stdout);
  const auto quit = [](gpointer data) -> gboolean {
    g_main_loop_quit(static_cast<GMainLoop*>(data));
    return FALSE;
  };
  g_timeout_add_seconds(static_cast<guint>(std::atoi(argv[1])), quit, loop);
  g_main_loop_run(loop);
  return 0;
}
