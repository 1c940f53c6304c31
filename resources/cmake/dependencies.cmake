# What the parts above core/ need. OSG offers variables only, so it is wrapped once, as system includes.
set(OpenGL_GL_PREFERENCE GLVND)
find_package(Threads REQUIRED)
find_package(Qt6 6.4 REQUIRED COMPONENTS Core Gui Widgets OpenGL Network PrintSupport Test)
find_package(OpenGL REQUIRED COMPONENTS OpenGL EGL)
find_package(OpenSceneGraph 3.6.5 REQUIRED COMPONENTS osgDB osgGA osgUtil osgText osgParticle osgSim osgViewer)
find_package(QCustomPlotQt6 REQUIRED)
find_package(GDAL CONFIG REQUIRED)
find_package(CLI11 REQUIRED)

add_library(trimtab_osg INTERFACE)
target_include_directories(trimtab_osg SYSTEM INTERFACE ${OPENSCENEGRAPH_INCLUDE_DIRS})
target_link_libraries(trimtab_osg INTERFACE ${OPENSCENEGRAPH_LIBRARIES} OpenGL::OpenGL)
