"""The router of rmw_zenoh and the bridge of one hand: ros2 launch tenax_msgs bridge.launch.py port:=/dev/ttyACM0 name:=left.

`tenax-bridge` is on the path after `cargo install --locked --path bridge`.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, TimerAction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    bridge = ExecuteProcess(
        cmd=["tenax-bridge", "--port", LaunchConfiguration("port"), "--name", LaunchConfiguration("name")],
        output="screen",
        respawn=True,
        respawn_delay=2.0,
    )
    return LaunchDescription([
        DeclareLaunchArgument("port", default_value="/dev/ttyACM0"),
        DeclareLaunchArgument("name", default_value="hand"),
        Node(package="rmw_zenoh_cpp", executable="rmw_zenohd", output="screen"),
        # The bridge gives up after 3 s without a router.
        TimerAction(period=1.0, actions=[bridge]),
    ])
