/// hammer_loads_node: the live node.
#include "hammer_loads/ros/hammer_loads_node.h"
#include "hammer_loads/ros/run_node.h"

int main(int argc, char** argv) { return hammer_loads::runNode(argc, argv, "hammer_loads", hammer_loads::makeHammerNode); }
