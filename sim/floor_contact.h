#pragma once

class btCollisionDispatcher;

namespace simwright::sim {

// Makes `dispatcher` collide a compound, whose user pointer is its BulletShape, with a plane as a
// whole. Bullet itself collides each convex part: a cup of 38 parts then has 38 contacts, while the
// hull of all parts gives the same support with at most four, in a tenth of the time.
void CollideShapesWithFloor(btCollisionDispatcher* dispatcher);

}  // namespace simwright::sim
