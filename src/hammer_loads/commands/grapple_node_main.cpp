/// grapple_node: the live grapple.
#include "hammer_loads/ros/grapple_node.h"
#include "hammer_loads/ros/run_node.h"

int main(int argc, char** argv) { return hammer_loads::runNode(argc, argv, "grapple", hammer_loads::makeGrappleNode); }
